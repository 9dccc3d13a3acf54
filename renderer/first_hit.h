// SPDX-License-Identifier: Apache-2.0
// What a path tells beside its colour, where that is asked for: the first hit that is no mirror or smooth
// glass, and its radiance by wavelength.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/spectra/lane_to_xyz.h"
#include "renderer/albedo.h"
#include "renderer/geometry.h"
#include "renderer/layers.h"

namespace spectrace {

/// The first surface met that is no hole, mirrors and glass included.
struct FirstSurface {
  bool is_known = false;
  std::uint32_t shape = 0, instance = kNone, material = 0;
};

struct FirstHit {
  bool is_known = false;
  LobeAlbedo albedo;
  Vec3 normal;  ///< shading normal, world, on the viewer's side
  Vec3 position;
  double depth = 0;  ///< length of the path to it, mirrors and glass included [m]
  FirstSurface surface;

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

  template <LayerSet kLayers, std::size_t kSize>
  void add(const SampledWavelengths& lambda, const std::array<LaneSums, kSize>& sums) {
    Deposit& deposit = deposits[count++];
    deposit.lambda = lambda;
    for (std::size_t i = 0; i < kSpectralLayers.size(); ++i) {
      if (kLayers.has(kSpectralLayers[i])) deposit.radiance[i] = sums[kLayers.slot(kSpectralLayers[i])];
    }
  }
};

}  // namespace spectrace
