// SPDX-License-Identifier: Apache-2.0
// What of a BSDF's value each lobe has, and radiance split by it: how light is parted into layers (ADR 0006).
#pragma once

#include <algorithm>
#include <span>

#include "core/spectra/lane_to_xyz.h"
#include "materials/bsdf.h"
#include "renderer/layers.h"

namespace spectrace {

/// By lane.
struct LobeShares {
  SampledSpectrum diffuse;               ///< in [0, 1]; the rest is specular
  SampledSpectrum fresnel, diffraction;  ///< signed; the rest of specular is residual
};

/// `kParts`: within specular, its Fresnel part, diffraction effect and residual too.
template <bool kParts>
LobeShares lobe_shares(const LobeValues& lobes) {
  const SampledSpectrum total = lobes.total();
  LobeShares share;
  for (int lane = 0; lane < kLanes; ++lane) {
    if (!(total[lane] > 0)) continue;
    // Clamped: rounding of a sum of lobes, or a residual that takes from the diffuse lobe, must not make the
    // specular one negative.
    share.diffuse[lane] = std::clamp(lobes.diffuse[lane] / total[lane], Float(0), Float(1));
    if constexpr (kParts) {
      share.fresnel[lane] = lobes.fresnel[lane] / total[lane];
      share.diffraction[lane] = lobes.diffraction[lane] / total[lane];
    }
  }
  return share;
}

/// Of a material that has one lobe.
inline LobeShares lobe_shares(Lobe only) {
  LobeShares share;
  (only == Lobe::kDiffuse ? share.diffuse : share.fresnel) = SampledSpectrum(1);
  return share;
}

/// Adds `radiance` to the lobes' layers of `sums`, which are those of `kLayers` in their order.
template <LayerSet kLayers>
void add_split(std::span<LaneSums> sums, const SampledSpectrum& radiance, const LobeShares& share,
               [[maybe_unused]] bool is_direct) {
  const auto to = [&](Layer layer) -> LaneSums& { return sums[kLayers.slot(layer)]; };
  const auto part = [](Float all, Float of_it) { return double(all) * double(of_it); };
  const auto rest = [](Float all, Float of_it) { return double(all) - double(all) * double(of_it); };
  to(Layer::kDiffuse).add(part, radiance, share.diffuse);
  to(Layer::kSpecular).add(rest, radiance, share.diffuse);
  if constexpr (kLayers.has(Layer::kSpecularFresnel)) {
    const auto residual = [&](Float all, Float diffuse, Float fresnel, Float diffraction) {
      return rest(all, diffuse) - part(all, fresnel) - part(all, diffraction);
    };
    to(Layer::kSpecularFresnel).add(part, radiance, share.fresnel);
    to(Layer::kSpecularDiffraction).add(part, radiance, share.diffraction);
    to(Layer::kSpecularResidual).add(residual, radiance, share.diffuse, share.fresnel, share.diffraction);
  }
  if constexpr (kLayers.has(Layer::kDiffuseDirect)) {
    if (!is_direct) return;
    to(Layer::kDiffuseDirect).add(part, radiance, share.diffuse);
    to(Layer::kSpecularDirect).add(rest, radiance, share.diffuse);
  }
}

}  // namespace spectrace
