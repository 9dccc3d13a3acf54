// SPDX-License-Identifier: Apache-2.0
// What the samples of one pixel add up to, as one row of numbers: sums, so that ranges of samples are joined
// by adding.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "renderer/layers.h"

namespace spectrace {

/// What is seen at the first hit that is no mirror or smooth glass; three numbers each, but for the depth.
enum class Feature : std::uint8_t { kDiffuseAlbedo, kSpecularAlbedo, kAlbedo, kNormal, kPosition, kDepth };
inline constexpr std::array kFeatureList{Feature::kDiffuseAlbedo, Feature::kSpecularAlbedo, Feature::kAlbedo,
                                         Feature::kNormal,        Feature::kPosition,       Feature::kDepth};
inline constexpr std::size_t kFeatureNumbers = 16;
/// Where a feature's numbers begin among those of all.
constexpr std::size_t feature_begin(Feature feature) { return 3 * std::size_t(feature); }
constexpr std::size_t feature_size(Feature feature) { return feature == Feature::kDepth ? 1 : 3; }
using FeatureNumbers = std::array<double, kFeatureNumbers>;

/// Layers that have halves and variances: beauty, diffuse, specular.
inline constexpr std::size_t kMomentLayers = 3;

/// Places in the row, which is made of fours, as registers are: the fourth beside three of a colour is free
/// or holds a count. What leaner kernels fill comes first.
namespace slots {
inline constexpr std::size_t kFour = 4;
/// X, Y, Z of a layer.
constexpr std::size_t xyz(Layer layer) { return kFour * std::size_t(layer); }
inline constexpr std::size_t kXyzEnd = kFour * std::size_t(kLayerCount);
/// X, Y, Z of half B (samples_in_half_b), and squares of R, G, B, of the moment layers.
constexpr std::size_t b_xyz(std::size_t layer) { return kXyzEnd + kFour * layer; }
constexpr std::size_t rgb_squares(std::size_t layer) { return b_xyz(kMomentLayers) + kFour * layer; }
/// Samples dropped as if never drawn: not finite, or negative; and those of half B.
inline constexpr std::size_t kInvalid = xyz(Layer::kBeauty) + 3;
inline constexpr std::size_t kInvalidB = b_xyz(0) + 3;
/// Vertices on measured BRDFs seen from beyond the last measured elevation.
inline constexpr std::size_t kExtrapolated = rgb_squares(0) + 3;
/// The features' numbers, and their squares.
inline constexpr std::size_t kFeatures = rgb_squares(kMomentLayers);
inline constexpr std::size_t kFeatureSquares = kFeatures + kFeatureNumbers;
inline constexpr std::size_t kCount = kFeatureSquares + kFeatureNumbers;
static_assert(kFeatureNumbers % kFour == 0);
}  // namespace slots

/// What half B is told by: of each moment layer the X, Y, Z of the right half of a block, and beside those of
/// the beauty its invalid samples.
template <typename Visit>
constexpr void for_each_half_slot(const Visit& visit) {
  constexpr std::size_t kNumbers = slots::kFour * kMomentLayers;
  for (std::size_t i = 0; i < kNumbers; ++i) visit(slots::b_xyz(0) + i, slots::xyz(Layer(0)) + i);
}

/// The first `kSize` places.
template <std::size_t kSize>
struct PixelSums {
  alignas(slots::kFour * sizeof(double)) std::array<double, kSize> v{};

  /// Joins the right half of a block to the left one.
  PixelSums& operator+=(const PixelSums& right) {
    for (std::size_t i = 0; i < kSize; ++i) v[i] += right.v[i];
    if constexpr (kSize > slots::kInvalidB) {
      for_each_half_slot([&](std::size_t b, std::size_t all) { v[b] = right.v[all]; });
    }
    return *this;
  }
};

/// Of all samples of a pixel, and how many of them count.
struct PixelTotal {
  std::array<double, slots::kCount> v{};
  double valid = 0, valid_b = 0;

  [[nodiscard]] std::array<double, 3> three(std::size_t slot) const {
    return {v[slot], v[slot + 1], v[slot + 2]};
  }
};

}  // namespace spectrace
