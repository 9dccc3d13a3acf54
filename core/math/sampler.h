// SPDX-License-Identifier: Apache-2.0
// Counter-based random numbers: a function of (pixel, sample index, dimension, seed), so that an image has
// the same bits for any thread count, tile order and split of the sample range.
#pragma once

#include <cstdint>

#include "core/math/vec.h"

namespace spectrace {

/// The numbers a path uses, by name. Each vertex owns a block of its own: a feature that is off leaves
/// its numbers unused and cannot shift those of another (ADR 0003).
enum class PathDimension : std::uint32_t {
  // once a path
  kWavelength = 0,
  kPixel = 1,  // 2
  kLens = 3,   // 2
  kCameraEnd = 5,
};
enum class VertexDimension : std::uint32_t {
  kLightChoice = 0,
  kLight = 1,  // 2
  kBsdfLobe = 3,
  kBsdf = 4,  // 2
  kRoulette = 6,
  kMask = 7,
  kEnd = 8,
};

/// The numbers of one sample of one pixel, each in [0, 1). Over the samples of a pixel every number, and
/// every pair of get2d(), is an Owen-scrambled Sobol' sequence with a scrambling and an order of its own:
/// each aligned block of 2^k samples has one in every stratum of width 2^-k, and one in every elementary box
/// of area 2^-k of a pair. Different numbers, and different pixels, are independent. kWavelength is
/// stratified for heroes and lanes, kPixel an additive recurrence.
class Sampler {
 public:
  /// `pixel` = y · width + x of the whole image, crop windows included.
  Sampler(std::uint64_t pixel, std::uint64_t sample, std::uint64_t seed);

  [[nodiscard]] Float get1d(PathDimension d) const { return number(static_cast<std::uint32_t>(d)); }
  [[nodiscard]] Vec2 get2d(PathDimension d) const { return pair(static_cast<std::uint32_t>(d)); }
  /// `vertex` = 0 for the first surface hit.
  [[nodiscard]] Float get1d(std::uint32_t vertex, VertexDimension d) const {
    return number(index(vertex, d));
  }
  [[nodiscard]] Vec2 get2d(std::uint32_t vertex, VertexDimension d) const { return pair(index(vertex, d)); }

 private:
  static constexpr std::uint32_t index(std::uint32_t vertex, VertexDimension d) {
    return static_cast<std::uint32_t>(PathDimension::kCameraEnd) +
           vertex * static_cast<std::uint32_t>(VertexDimension::kEnd) + static_cast<std::uint32_t>(d);
  }
  struct Keys {
    std::uint32_t order = 0, digits = 0;
  };
  [[nodiscard]] Keys keys(std::uint32_t dimension) const;
  [[nodiscard]] std::uint32_t shuffled_index(std::uint32_t order_key) const;
  [[nodiscard]] Float number(std::uint32_t dimension) const;
  [[nodiscard]] Vec2 pair(std::uint32_t dimension) const;
  [[nodiscard]] std::uint64_t bits(std::uint32_t dimension) const;
  [[nodiscard]] std::uint64_t pixel_offset(std::uint32_t dimension) const;

  std::uint64_t pixel_key_;
  std::uint64_t sample_;
  std::uint64_t block_key_;  // of 2^32 samples
  std::uint32_t reversed_sample_;
};

}  // namespace spectrace
