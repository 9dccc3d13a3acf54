// SPDX-License-Identifier: Apache-2.0
// Sums of XYZ by pixel and layer, in double; box filter: a sample counts for the pixel it falls in.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/image/image.h"
#include "core/spectra/color.h"

namespace spectrace {

/// Beauty = the sum of the four layers after it; specular = the sum of its three parts, of which the last two
/// are signed (paper, eq. 21; ADR 0007).
enum class Layer : std::uint8_t {
  kBeauty,
  kDiffuse,
  kSpecular,
  kEmission,
  kBackground,
  kSpecularFresnel,
  kSpecularDiffraction,
  kSpecularResidual,
};
inline constexpr int kLayerCount = 8;
constexpr bool is_signed(int layer) { return layer > int(Layer::kSpecularFresnel); }

/// How many of the layers are kept apart, from the first on.
enum class LayerSet : std::uint8_t { kBeauty = 1, kLobes = 5, kSpecularParts = kLayerCount };

/// What one path brings.
struct PathValue {
  std::array<Xyz, kLayerCount> xyz{};
  bool valid = true;  ///< all of it finite and >= 0
  /// Vertices on measured BRDFs, and those of them seen from beyond the last measured elevation.
  std::uint32_t measured = 0, extrapolated = 0;
};

/// Pixels may be added to from several threads as long as each pixel has one.
class Film {
 public:
  Film(int width, int height);

  /// An invalid path is dropped as if never drawn, and counted.
  void add(int x, int y, const PathValue& value);

  /// Channels of RenderResult::image, as far as `layers` goes.
  [[nodiscard]] Image resolve(LayerSet layers) const;
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
