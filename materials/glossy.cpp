// SPDX-License-Identifier: Apache-2.0
#include "materials/glossy.h"

#include "core/math/math.h"
#include "materials/lambert.h"

namespace spectrace {

namespace {

struct Parts {
  SampledSpectrum diffuse, specular;  // f · cosθi
};

Parts parts(const Glossy& g, const SampledSpectrum& diffuse_albedo, const Ggx::Reflection& r, Vec3 wi,
            const ShadingPoint& at) {
  return {diffuse_albedo * (wi.z * kInvPi),
          reflectance(g.fresnel, r.cos_half, at.lambda) * (g.specular_scale * r.value_cos)};
}

SampledSpectrum scaled_albedo(const Glossy& g, const ShadingPoint& at) {
  return g.reflectance.sample(at.lambda, at.uv, at.footprint) * g.diffuse_scale;
}

}  // namespace

Glossy::Mix Glossy::mix(Vec3 wo, const ShadingPoint& at) const {
  const SampledSpectrum albedo = scaled_albedo(*this, at);
  const Float diffuse = albedo.average();
  const Float specular = specular_scale * spectrace::reflectance(fresnel, wo.z, at.lambda).average();
  return {.diffuse_albedo = albedo,
          .specular_probability = safe_div(specular, specular + diffuse),
          .is_empty = specular == 0 && diffuse == 0};
}

BsdfValue Glossy::evaluate(const Mix& mix, Vec3 wo, Vec3 wi, const ShadingPoint& at) const {
  if (wi.z <= 0 || mix.is_empty) return {};
  const Ggx::Reflection r = ggx.reflect(wo, wi);
  const Parts p = parts(*this, mix.diffuse_albedo, r, wi, at);
  return {p.diffuse + p.specular, lerp(wi.z * kInvPi, r.pdf, mix.specular_probability)};
}

BsdfValue Glossy::evaluate(Vec3 wo, Vec3 wi, const ShadingPoint& at) const {
  if (wo.z <= 0 || wi.z <= 0) return {};
  return evaluate(mix(wo, at), wo, wi, at);
}

LobeValues Glossy::evaluate_lobes(Vec3 wo, Vec3 wi, const ShadingPoint& at) const {
  if (wo.z <= 0 || wi.z <= 0) return {};
  const Parts p = parts(*this, scaled_albedo(*this, at), ggx.reflect(wo, wi), wi, at);
  return {.diffuse = p.diffuse, .fresnel = p.specular, .diffraction = {}};
}

std::optional<BsdfSample> Glossy::sample(Vec3 wo, const BsdfRandom& u, const ShadingPoint& at) const {
  if (wo.z <= 0) return std::nullopt;
  const Mix m = mix(wo, at);
  const Float specular = m.specular_probability;
  const bool choose_specular = specular > 0 && (specular == 1 || u.lobe < specular);
  const Vec3 wi = choose_specular ? ggx.sample(wo, u.direction) : sample_cosine_hemisphere(u.direction);
  const BsdfValue value = evaluate(m, wo, wi, at);
  if (value.pdf <= 0) return std::nullopt;
  return BsdfSample{.wi = wi,
                    .weight = value.value_cos / value.pdf,
                    .pdf = value.pdf,
                    .lobe = choose_specular ? Lobe::kSpecular : Lobe::kDiffuse};
}

}  // namespace spectrace
