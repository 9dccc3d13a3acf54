// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/spectra/spectrum.h"
#include "materials/bsdf.h"
#include "materials/fresnel.h"

namespace spectrace {

/// Smooth glass: the interior has the index `eta` (> 0), the exterior (normal side) 1. Both directions may
/// lie on either side. sample() carries radiance from wi to wo: refraction scales it by (η_o / η_i)², since
/// L/η² is what an interface conserves (Veach 1997, sec. 5.2) - 1/eta² for wo outside, eta² for wo inside.
/// Where eta varies with wavelength, refraction follows the hero and is flagged dispersive; reflection keeps
/// all wavelengths.
struct Dielectric {
  Spectrum eta = Spectrum::constant(Float(1.5));
  std::optional<ThinFilm> film{};  ///< on the outside

  [[nodiscard]] BsdfValue evaluate(Vec3, Vec3, const ShadingPoint&) const { return {}; }
  [[nodiscard]] LobeValues evaluate_lobes(Vec3, Vec3, const ShadingPoint&) const { return {}; }
  /// u.lobe chooses between reflection (with the hero's Fresnel reflectance, under a film the lanes' mean:
  /// the hero's may vanish) and refraction.
  [[nodiscard]] std::optional<BsdfSample> sample(Vec3 wo, const BsdfRandom& u, const ShadingPoint& at) const;
  [[nodiscard]] bool is_delta() const { return true; }
};

static_assert(Bsdf<Dielectric>);

}  // namespace spectrace
