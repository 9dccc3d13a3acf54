// SPDX-License-Identifier: Apache-2.0
// The grid of the paper's table X over the half-difference angles, and where a direction pair falls in it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "materials/half_difference.h"

namespace spectrace {

/// Where a direction pair falls in the grid: the one mapping all lookups use. Weights sum to 1.
/// Made by locate() alone, which sets all of it: to clear it first would take as long.
struct GridPoint {
  std::array<std::uint32_t, 8> cell;  ///< trilinear, index into [theta_h][theta_d][phi_d]
  std::array<float, 8> cell_weight;
  /// Sign, at the lower and the upper phi_d, of what is odd in the exchange of the directions: cell[2 i] and
  /// cell[2 i + 1]. The table holds half the circle; the other half is the exchanged pair.
  std::array<float, 2> odd_sign;
  std::array<std::uint32_t, 4> angular;  ///< bilinear, index into [theta_h][theta_d]
  std::array<float, 4> angular_weight;
  std::array<std::uint32_t, 2> theta_d;  ///< linear
  std::array<float, 2> theta_d_weight;
};

/// The table X and everything on its grid: [theta_h][theta_d][phi_d], nodes at theta_h(i) (paper: 90 of
/// them), theta_d = j · 90°/n_d, phi_d = k · 180°/n_p with wrap-around.
struct HalfDifferenceGrid {
  int n_theta_h = 90, n_theta_d = 90, n_phi_d = 180;
  bool quadratic_theta_h = true;  ///< theta_h = (i/n)² 90° as in MERL; otherwise i/n · 90°

  [[nodiscard]] std::size_t size() const { return std::size_t(n_theta_h) * n_theta_d * n_phi_d; }
  [[nodiscard]] std::size_t angular_size() const { return std::size_t(n_theta_h) * n_theta_d; }
  [[nodiscard]] std::size_t index(int h, int d, int p) const {
    return (std::size_t(h) * n_theta_d + d) * n_phi_d + p;
  }
  [[nodiscard]] double theta_h(double i) const;  ///< [rad] of a (fractional) node
  [[nodiscard]] double theta_d(double j) const;
  [[nodiscard]] double phi_d(double k) const;
  [[nodiscard]] double coordinate_h(double theta_h_rad) const;  ///< the inverses, clamped to the grid
  [[nodiscard]] double coordinate_d(double theta_d_rad) const;
  [[nodiscard]] double coordinate_p(double phi_d_rad) const;  ///< in [0, n_phi_d)
  [[nodiscard]] GridPoint locate(const HalfDifference& angles) const;

  /// A grid dimension beyond this is no measurement, but would overflow `int` arithmetic on indices.
  static constexpr std::size_t kMaxDimension = 1 << 14;
  /// Nor may size() be beyond this: GridPoint counts cells in 32 bits.
  static constexpr std::size_t kMaxSize = std::numeric_limits<std::uint32_t>::max();
};

}  // namespace spectrace
