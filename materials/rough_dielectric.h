// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/spectra/spectrum.h"
#include "materials/bsdf.h"
#include "materials/fresnel.h"
#include "materials/microfacet.h"

namespace spectrace {

/// An index nearer to 1 bends light less than a half vector of single precision tells: at this distance it is
/// known to 2^-24 / 0.01 = 6e-6 rad, a hundredth of the narrowest lobe's width.
inline constexpr Float kMinRoughContrast = Float(0.01);

/// Ground glass: reflection F D G2 / (4 cosθi cosθo) and refraction, Walter et al. 2007, eqs. 20-21, through
/// GGX facets. The sides, and the scaling of radiance, are those of the smooth Dielectric. Single scattering:
/// energy lost between facets is not given back.
///
/// Where eta varies, each lane refracts through half vectors of its own, and all of them go on. The lane that
/// a direction is drawn for is chosen evenly, and the density is the mean over the lanes: the balance
/// heuristic over wavelengths (Wilkie et al. 2014, sec. 3). To follow the hero alone instead would be biased:
/// light sampling weighs all lanes with one density, and the hero's is 0 where only others refract to.
class RoughDielectric {
 public:
  static constexpr Lobe kOnlyLobe = Lobe::kSpecular;
  RoughDielectric() : RoughDielectric(Spectrum::constant(Float(1.5)), {}) {}
  /// `eta` of the interior > 0, kMinRoughContrast from 1 at every wavelength; `film` on the outside of every
  /// facet.
  RoughDielectric(Spectrum eta, Ggx ggx, std::optional<ThinFilm> film = std::nullopt)
      : eta_(std::move(eta)), ggx_(ggx), film_(std::move(film)), varies_(film_ || !eta_.is_constant()) {}

  [[nodiscard]] BsdfValue evaluate(Vec3 wo, Vec3 wi, const ShadingPoint& at) const;
  [[nodiscard]] LobeValues evaluate_lobes(Vec3 wo, Vec3 wi, const ShadingPoint& at) const;
  [[nodiscard]] std::optional<BsdfSample> sample(Vec3 wo, const BsdfRandom& u, const ShadingPoint& at) const;
  [[nodiscard]] bool is_delta() const { return false; }

  [[nodiscard]] const Spectrum& eta() const { return eta_; }
  [[nodiscard]] const Ggx& ggx() const { return ggx_; }
  [[nodiscard]] const std::optional<ThinFilm>& film() const { return film_; }

 private:
  /// The index beyond the interface over that on wo's side, and how many lanes differ and are alive: 1 stands
  /// for all where they do not differ.
  struct Lanes {
    SampledSpectrum eta;
    SampledSpectrum film_eta, lambda_nm;  // where there is a film
    int count = 1;
    bool outside = true;
  };
  [[nodiscard]] Lanes lanes(bool outside, const SampledWavelengths& lambda) const;
  [[nodiscard]] Float reflectance(const Lanes& lanes, int lane, Float cos_half) const;
  /// wo.z > 0.
  [[nodiscard]] BsdfValue evaluate(const Lanes& lanes, Vec3 wo, Vec3 wi) const;

  Spectrum eta_;
  Ggx ggx_;
  std::optional<ThinFilm> film_;
  bool varies_;
};

static_assert(Bsdf<RoughDielectric>);

}  // namespace spectrace
