// SPDX-License-Identifier: Apache-2.0
// What of a BSDF's value each lobe has: how light is parted into layers (ADR 0006).
#pragma once

#include <algorithm>
#include <optional>

#include "materials/bsdf.h"

namespace spectrace {

/// By lane.
struct LobeShares {
  std::optional<Lobe> only;              ///< has all of it, and what follows means nothing
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

}  // namespace spectrace
