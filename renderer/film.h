// SPDX-License-Identifier: Apache-2.0
// Sums of XYZ by pixel and layer, in double; box filter: a sample counts for the pixel it falls in.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/image/image.h"
#include "core/spectra/color.h"

namespace spectrace {

enum class Layer : std::uint8_t { kBeauty, kDiffuse, kSpecular, kEmission, kBackground };
inline constexpr int kLayerCount = 5;

/// Radiance of one path by lane, in double: the layers of a path then sum to its beauty to 1e-15.
struct LaneSums {
  std::array<double, kLanes> v{};
};

/// What one path brings.
struct PathValue {
  std::array<Xyz, kLayerCount> xyz{};
  bool valid = true;  ///< all of it finite and >= 0
  /// Vertices on measured BRDFs, and those of them seen from beyond the last measured elevation.
  std::uint32_t measured = 0, extrapolated = 0;
};

/// How much each lane of a path adds to X, Y and Z.
class LaneToXyz {
 public:
  /// Lanes of density 0 (terminated) add nothing.
  explicit LaneToXyz(const SampledWavelengths& lambda);
  /// Adds `sums` to `xyz`. False where a lane that counts is negative or not finite.
  bool add(const LaneSums& sums, Xyz& xyz) const;

 private:
  std::array<Xyz, kLanes> weight_{};
  std::array<bool, kLanes> counts_{};
};

/// Pixels may be added to from several threads as long as each pixel has one.
class Film {
 public:
  Film(int width, int height);

  /// An invalid path is dropped as if never drawn, and counted.
  void add(int x, int y, const PathValue& value);

  /// Channels of RenderResult::image; without `layers` R, G, B and diagnostics.invalid alone.
  [[nodiscard]] Image resolve(bool layers) const;
  [[nodiscard]] std::uint64_t invalid_samples() const;
  /// Of all vertices on measured BRDFs; 0 where there are none.
  [[nodiscard]] double extrapolated_share() const;
  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }

 private:
  struct Pixel {
    std::array<Xyz, kLayerCount> sum{};
    std::uint64_t valid = 0, invalid = 0, measured = 0, extrapolated = 0;
  };
  int width_, height_;
  std::vector<Pixel> pixels_;
};

}  // namespace spectrace
