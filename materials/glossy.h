// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/image/texture.h"
#include "materials/bsdf.h"
#include "materials/fresnel.h"
#include "materials/microfacet.h"

namespace spectrace {

/// f = diffuse_scale · reflectance / π + specular_scale · F D G2 / (4 cosθi cosθo).
/// The scales are the shares of the surface each lobe covers: with their sum at most 1 (parse_material holds
/// it) no energy is made. The diffuse lobe is exactly Lambertian, the sum the paper separates (eq. 1).
struct Glossy {
  Texture reflectance;  ///< of the diffuse lobe, in [0, 1]
  SpecularFresnel fresnel;
  Ggx ggx;
  Float diffuse_scale = Float(0.5);
  Float specular_scale = Float(0.5);

  [[nodiscard]] BsdfValue evaluate(Vec3 wo, Vec3 wi, const ShadingPoint& at) const;
  [[nodiscard]] LobeValues evaluate_lobes(Vec3 wo, Vec3 wi, const ShadingPoint& at) const;
  /// Chooses the lobe by its expected energy: reflectance, and Fresnel at wo, averaged over the lanes.
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
    Float specular_probability = 0;
    bool is_empty = false;  ///< neither lobe reflects: none is ever chosen
  };
  [[nodiscard]] Mix mix(Vec3 wo, const ShadingPoint& at) const;
  [[nodiscard]] BsdfValue evaluate(const Mix& mix, Vec3 wo, Vec3 wi, const ShadingPoint& at) const;
};

static_assert(Bsdf<Glossy>);

}  // namespace spectrace
