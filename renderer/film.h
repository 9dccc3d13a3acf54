// SPDX-License-Identifier: Apache-2.0
// Sums of XYZ by pixel and layer, in double; box filter: a sample counts for the pixel it falls in.
#pragma once

#include <array>
#include <cstdint>
#include <span>
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

/// What the samples of one pixel bring.
struct PixelSums {
  std::array<Xyz, kLayerCount> xyz{};  ///< of the layers that are kept
  /// An invalid path is dropped as if never drawn, and counted.
  std::uint32_t valid = 0, invalid = 0;
};

/// Holds what is asked for: 24 bytes a layer and 8 more for each pixel. Pixels may be added to from several
/// threads as long as each pixel has one.
class Film {
 public:
  Film(int width, int height, LayerSet layers);

  void add(int x, int y, const PixelSums& sums);

  /// Channels of RenderResult::image.
  [[nodiscard]] Image resolve() const;
  [[nodiscard]] std::uint64_t invalid_samples() const;
  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }

 private:
  struct Counts {
    std::uint32_t valid = 0, invalid = 0;
  };
  int width_, height_;
  std::size_t layers_;
  std::vector<Xyz> sums_;  // pixel by pixel, layer by layer
  std::vector<Counts> counts_;
};

}  // namespace spectrace
