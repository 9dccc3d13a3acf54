// SPDX-License-Identifier: Apache-2.0
// The GGX microfacet distribution with Smith's height-correlated masking and shadowing, and the reflecting
// lobe they make: everything of it but the Fresnel factor.
#pragma once

#include "core/math/vec.h"

namespace spectrace {

/// The narrowest lobe kept apart from a mirror: below it single precision no longer resolves the half vector.
inline constexpr Float kMinAlpha = Float(1e-3);

/// All directions unit, in the shading frame. `alpha_x`, `alpha_y` in [kMinAlpha, 1]: the slope parameters
/// themselves (Walter et al. 2007, eq. 33; Heitz 2014, eq. 85), no remapped "roughness".
struct Ggx {
  Float alpha_x = Float(0.1), alpha_y = Float(0.1);

  /// D(wm) [1/sr]: ∫ D cosθm dωm = 1 over the hemisphere; 0 below it.
  [[nodiscard]] Float distribution(Vec3 wm) const;
  /// Smith's G1 of a direction above the horizon, in [0, 1] (Heitz 2014, eq. 43).
  [[nodiscard]] Float masking(Vec3 w) const;

  struct Reflection {
    Float value_cos = 0;  ///< D G2 / (4 cosθo) [1/sr]: f · cosθi for a Fresnel factor of 1
    Float pdf = 0;        ///< density [1/sr] of sample() returning wi
    Float cos_half = 0;   ///< wo·wm = wi·wm, for the Fresnel factor
  };
  /// Zeros unless both directions lie above the horizon.
  [[nodiscard]] Reflection reflect(Vec3 wo, Vec3 wi) const;

  struct Refraction {
    Float value_cos = 0;  ///< f · |cosθi| [1/sr] for a transmittance of 1, of radiance: with 1/eta² in it
    Float pdf = 0;        ///< density [1/sr] of wi where the facet is drawn from those visible to wo
    Float cos_half = 0;   ///< wo·wm > 0, for the Fresnel factor
  };
  /// `wo.z` > 0, `wi.z` < 0, `eta` = index beyond the interface over that on wo's side, not 1. Zeros where no
  /// facet refracts one direction into the other.
  [[nodiscard]] Refraction refract(Vec3 wo, Vec3 wi, Float eta) const;

  /// The normal of a facet drawn from those visible to wo, of any length; {} where u is drawn from the rim
  /// opposite to wo. `wo.z` > 0, `u` in [0, 1]².
  [[nodiscard]] Vec3 visible_normal(Vec3 wo, Vec2 u) const;
  /// The direction wo is mirrored into by such a facet; it may lie below the horizon.
  [[nodiscard]] Vec3 sample(Vec3 wo, Vec2 u) const;
};

}  // namespace spectrace
