// SPDX-License-Identifier: Apache-2.0
// A glossy surface rough at two scales: facets that mirror, and a roughness of the order of the wavelength on
// them that diffracts. After Holzschuch & Pacanowski 2017, "A Two-Scale Microfacet Reflectance Model
// Combining Reflection and Diffraction"; docs/materials.md says what is left out.
#pragma once

#include "core/image/texture.h"
#include "materials/bsdf.h"
#include "materials/fresnel.h"
#include "materials/microfacet.h"

namespace spectrace {

/// Heights with the K-correlation power spectrum S(f) ∝ σ² / (1 + (b f)²)^(s/2): Krywonos, Harvey & Choi
/// 2011.
struct MicroRoughness {
  Float rms_nm = 0;             ///< σ >= 0
  Float correlation_nm = 1000;  ///< b > 0; 1/b is where the spectrum bends
  Float exponent = 3;           ///< s > 2: how fast it falls beyond

  /// 1 - exp(-(4π σ cosθ / λ)²): the share of the reflected light that is diffracted, the total integrated
  /// scatter of a smooth surface (ibid. eq. 24).
  [[nodiscard]] Float diffracted(Float cos_theta, Float lambda_nm) const;
  /// S as a density over the plane of direction cosines, |ξ| = λ f: ∫ density d²ξ = 1.
  [[nodiscard]] Float density(Float xi_squared, Float lambda_nm) const;
  /// |ξ| drawn from it; infinite at u = 1. `u` in [0, 1].
  [[nodiscard]] Float sample_radius(Float u, Float lambda_nm) const;
};

/// f = diffuse_scale · reflectance / π
///   + specular_scale · F · [(1 - A(max(cosθi, cosθo))) · D G2 / (4 cosθi cosθo)
///                           + A(min(cosθi, cosθo)) · S(|ξi + ξo|)]
/// with A = MicroRoughness::diffracted, S its density and ξ the tangential part of a direction (generalised
/// Harvey-Shack). The larger and the smaller cosine make the model reciprocal and keep its two specular parts
/// below 1 - A(cosθo) and A(cosθo): no energy is made. `evaluate_lobes` gives them as `fresnel` and
/// `diffraction`.
struct Diffractive {
  Texture reflectance;  ///< of the diffuse lobe, in [0, 1]
  SpecularFresnel fresnel;
  Ggx ggx;
  MicroRoughness micro;
  Float diffuse_scale = 0;
  Float specular_scale = 1;

  [[nodiscard]] BsdfValue evaluate(Vec3 wo, Vec3 wi, const ShadingPoint& at) const;
  [[nodiscard]] LobeValues evaluate_lobes(Vec3 wo, Vec3 wi, const ShadingPoint& at) const;
  /// Chooses the lobe by its expected energy, averaged over the lanes. Diffracted directions are drawn at one
  /// lane's wavelength, each as likely, so the density is the mean over the lanes.
  [[nodiscard]] std::optional<BsdfSample> sample(Vec3 wo, const BsdfRandom& u, const ShadingPoint& at) const;
  [[nodiscard]] bool is_delta() const { return false; }
  /// Share of light that the diffuse lobe sends to wo from all around.
  [[nodiscard]] SampledSpectrum diffuse_albedo(Vec3, const ShadingPoint& at) const {
    return reflectance.sample(at.lambda, at.uv, at.footprint) * diffuse_scale;
  }

 private:
  /// What depends on wo alone: found once a sample.
  struct Mix {
    SampledSpectrum diffuse_albedo;
    Float diffuse = 0, mirrored = 0, diffracted = 0;  ///< probabilities; all 0 where nothing reflects
  };
  [[nodiscard]] Mix mix(Vec3 wo, const ShadingPoint& at) const;
  [[nodiscard]] LobeValues lobes(const SampledSpectrum& diffuse_albedo, const Ggx::Reflection& r, Vec3 wo,
                                 Vec3 wi, const ShadingPoint& at) const;
  [[nodiscard]] BsdfValue evaluate(const Mix& mix, Vec3 wo, Vec3 wi, const ShadingPoint& at) const;
};

static_assert(Bsdf<Diffractive>);

}  // namespace spectrace
