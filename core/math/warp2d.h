// SPDX-License-Identifier: Apache-2.0
// Bilinear densities on the unit square, interpolated over up to two parameters: sampled, inverted and
// evaluated. The warp of Dupuy & Jakob 2018, sec. 4, and the sampler of every tabulated lobe here.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "core/math/vec.h"

namespace spectrace {

/// The parameter values a lookup asks for.
struct WarpParams {
  Float p0 = 0, p1 = 0;
};

/// A point of the unit square, in double (core/math/piecewise_linear.h).
struct UnitPoint {
  double x = 0, y = 0;

  constexpr UnitPoint() = default;
  constexpr UnitPoint(double px, double py) : x(px), y(py) {}
  constexpr UnitPoint(Vec2 v) : x(v.x), y(v.y) {}
  constexpr operator Vec2() const { return {static_cast<Float>(x), static_cast<Float>(y)}; }
};

/// A family of grids [p0][p1][height][width] over the unit square, nodes on its border; between nodes the
/// value is bilinear, between parameter values linear (the nearest end value holds outside their range).
/// Immutable.
class Warp2D {
 public:
  struct Sample {
    UnitPoint position;  ///< in [0, 1]²; x runs along the width
    Float pdf = 0;       ///< density per unit square area at `position`
  };

  /// The (at most four) slices around a parameter pair; their weights sum to 1. Families with the same
  /// parameter values share it, and so may any other table laid out [p0][p1].
  struct Blend {
    explicit Blend() = default;  // no aggregate: {p0, p1} must mean WarpParams
    std::array<std::size_t, 4> slice{};
    std::array<Float, 4> weight{};
    int count = 0;
  };
  /// A cell between two nodes of one axis, and how far into it.
  struct Cell {
    int index = 0;
    double fraction = 0;
  };

  Warp2D() = default;
  /// `p0`, `p1`: strictly increasing, at least one entry (checked); width, height >= 2; data.size() = the
  /// product of all, each finite and >= 0 (checked). With `normalize` each slice is scaled to integrate to
  /// 1 (a slice of zeros becomes uniform) and sample() and invert() may be called; without it only eval().
  Warp2D(std::span<const Float> p0, std::span<const Float> p1, int width, int height,
         std::span<const Float> data, bool normalize);

  /// Unit-square random numbers to a position of density eval(position). u in [0, 1]².
  [[nodiscard]] Sample sample(UnitPoint u, const Blend& blend) const;
  [[nodiscard]] Sample sample(UnitPoint u, WarpParams params = {}) const { return sample(u, blend(params)); }
  /// The u that sample() takes to `position`, with the density there.
  [[nodiscard]] Sample invert(UnitPoint position, const Blend& blend) const;
  [[nodiscard]] Sample invert(UnitPoint position, WarpParams params = {}) const {
    return invert(position, blend(params));
  }
  /// Bilinear value (density where normalised) at `position` in [0, 1]².
  [[nodiscard]] Float eval(UnitPoint position, const Blend& blend) const;
  [[nodiscard]] Float eval(UnitPoint position, WarpParams params = {}) const {
    return eval(position, blend(params));
  }

  [[nodiscard]] Blend blend(WarpParams params) const;
  /// `coordinate` is clamped to [0, 1]; index <= nodes - 2.
  [[nodiscard]] static Cell cell_at(double coordinate, int nodes);

 private:
  [[nodiscard]] double marginal(const Blend& b, int row) const;
  [[nodiscard]] double row_integral(const Blend& b, int row) const;
  [[nodiscard]] double conditional(const Blend& b, Cell row, int column) const;
  [[nodiscard]] double value(const Blend& b, Cell row, int column) const;
  [[nodiscard]] double value(const Blend& b, UnitPoint position) const;
  void normalize_slice(std::size_t slice);

  std::vector<Float> p0_, p1_;
  int width_ = 0, height_ = 0;
  std::vector<Float> data_;  // [slice][height][width]
  std::vector<double>
      marginal_;  // [slice][height]: mass below each node row; the last is 1 to Float rounding
  std::vector<double> conditional_;  // [slice][height][width]: integral along each node row, from x = 0
};

}  // namespace spectrace
