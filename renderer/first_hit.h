// SPDX-License-Identifier: Apache-2.0
// What a path tells beside its colour, where that is asked for: the first hit that is no mirror or smooth
// glass, and its radiance by wavelength.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "renderer/albedo.h"
#include "renderer/geometry.h"
#include "renderer/layer_sums.h"
#include "renderer/layers.h"
#include "renderer/pixel_sums.h"

namespace spectrace {

/// The first surface met that is no hole, mirrors and glass included.
struct FirstSurface {
  bool is_known = false;
  std::uint32_t shape = 0, instance = kNone, material = 0;
};

struct FirstHit {
  bool is_known = false;
  double depth = 0;         ///< length of the path so far, mirrors and glass included [m]
  FeatureNumbers features;  ///< once it is known
  FirstSurface surface;

  /// `normal`: for shading, world, on the viewer's side; `position` [m], world.
  void know(const LobeAlbedo& albedo, Vec3 normal, Vec3 position) {
    is_known = true;
    const auto set = [&](Feature feature, const std::array<double, 3>& numbers) {
      std::copy(numbers.begin(), numbers.end(), features.begin() + feature_begin(feature));
    };
    const auto doubles = [](Vec3 v) { return std::array{double(v.x), double(v.y), double(v.z)}; };
    Rgb sum{};
    for (std::size_t c = 0; c < 3; ++c) sum[c] = std::min(1.0, albedo.diffuse[c] + albedo.specular[c]);
    set(Feature::kDiffuseAlbedo, albedo.diffuse);
    set(Feature::kSpecularAlbedo, albedo.specular);
    set(Feature::kAlbedo, sum);
    set(Feature::kNormal, doubles(normal));
    set(Feature::kPosition, doubles(position));
    features[feature_begin(Feature::kDepth)] = depth;
  }

  /// After a way of `t`; whether it is a hole will be seen.
  void come_to(double t, const FirstSurface& met) {
    depth += t;
    if (!surface.is_known) surface = met;
  }
};

/// Layers that spectral images are made of; others are sums of them or differences.
inline constexpr std::array kSpectralLayers{Layer::kBeauty, Layer::kDiffuse, Layer::kSpecular};

/// Radiance of one path by lane. Twice at the most: a dispersive hit ends the secondary wavelengths.
struct LaneDeposits {
  struct Deposit {
    SampledWavelengths lambda;
    std::array<LaneSums, kSpectralLayers.size()> radiance;
  };
  std::array<Deposit, 2> deposits;
  std::size_t count = 0;

  template <LayerSet kLayers>
  void add(const SampledWavelengths& lambda, const LayerSums<kLayers>& sums) {
    Deposit& deposit = deposits[count++];
    deposit.lambda = lambda;
    for (std::size_t i = 0; i < kSpectralLayers.size(); ++i) {
      const Layer layer = kSpectralLayers[i];
      deposit.radiance[i] = sums.lit().has(layer) ? sums.of(layer) : LaneSums{};
    }
  }
};

}  // namespace spectrace
