// SPDX-License-Identifier: Apache-2.0
// How much an interface reflects: dielectric, conductor, thin film, Schlick's approximation. All for
// unpolarised light, and for waves written exp(-iωt), so that an absorbing medium has the index η + ik.
#pragma once

#include <optional>
#include <variant>

#include "core/base/float.h"
#include "core/spectra/sampled_spectrum.h"
#include "core/spectra/sampled_wavelengths.h"
#include "core/spectra/spectrum.h"

namespace spectrace {

/// `cos_i` in [0, 1]: angle on the side the light comes from; `eta` = index beyond / index before, > 0.
/// 1 at total internal reflection. Born & Wolf 1999, sec. 1.5.2, eqs. 32-33.
[[nodiscard]] Float fresnel_dielectric(Float cos_i, Float eta);

/// From vacuum onto η + ik; eta > 0, k >= 0. The same equations with a complex index: ibid. sec. 14.2.
[[nodiscard]] Float fresnel_conductor(Float cos_i, Float eta, Float k);

/// f0 + (1 - f0)(1 - cos)^5: Schlick 1994, eq. 15. `f0` in [0, 1].
[[nodiscard]] SampledSpectrum fresnel_schlick(Float cos_i, const SampledSpectrum& f0);

/// A transparent film in vacuum over η + ik (k = 0: a dielectric): Airy's sum of all internal reflections,
/// Born & Wolf 1999, sec. 7.6 and 14.4. `film_eta` >= 1; `thickness_nm` >= 0, where 0 gives the bare
/// interface.
[[nodiscard]] Float fresnel_thin_film(Float cos_i, Float lambda_nm, Float film_eta, Float thickness_nm,
                                      Float base_eta, Float base_k);

/// The same film between vacuum and a clear base, seen from either side; `cos_i` on that side. A stack
/// without losses sends back the same share of the light in either direction of a refracted ray: Born & Wolf
/// 1999, sec. 1.6.3, and all of it beyond the critical angle.
[[nodiscard]] Float fresnel_coated_dielectric(Float cos_i, bool outside, Float lambda_nm, Float base_eta,
                                              Float film_eta, Float thickness_nm);

/// A layer that shows interference colours.
struct ThinFilm {
  Spectrum eta;            ///< >= 1, real
  Float thickness_nm = 0;  ///< >= 0
};

/// A metal in vacuum, bare or under a film.
struct ConductorFresnel {
  Spectrum eta = Spectrum::constant(1);  ///< > 0
  Spectrum k;                            ///< >= 0
  std::optional<ThinFilm> film{};

  [[nodiscard]] SampledSpectrum reflectance(Float cos_i, const SampledWavelengths& lambda) const;
};

/// A colour at normal incidence that turns white at grazing.
struct SchlickFresnel {
  Spectrum f0;  ///< in [0, 1]

  [[nodiscard]] SampledSpectrum reflectance(Float cos_i, const SampledWavelengths& lambda) const;
};

using SpecularFresnel = std::variant<ConductorFresnel, SchlickFresnel>;
[[nodiscard]] SampledSpectrum reflectance(const SpecularFresnel& fresnel, Float cos_i,
                                          const SampledWavelengths& lambda);

}  // namespace spectrace
