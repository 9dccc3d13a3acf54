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
  return g.reflectance.sample(at.lambda, at.uv) * g.diffuse_scale;
}

}  // namespace

Float Glossy::specular_probability(const SampledSpectrum& diffuse_albedo, Vec3 wo,
                                   const ShadingPoint& at) const {
  const Float specular = specular_scale * spectrace::reflectance(fresnel, wo.z, at.lambda).average();
  return safe_div(specular, specular + diffuse_albedo.average());
}

BsdfValue Glossy::evaluate(Vec3 wo, Vec3 wi, const ShadingPoint& at) const {
  if (wo.z <= 0 || wi.z <= 0) return {};
  const SampledSpectrum diffuse_albedo = scaled_albedo(*this, at);
  const Ggx::Reflection r = ggx.reflect(wo, wi);
  const Parts p = parts(*this, diffuse_albedo, r, wi, at);
  const Float specular = specular_probability(diffuse_albedo, wo, at);
  const SampledSpectrum total = p.diffuse + p.specular;
  // Where neither lobe reflects, none is ever chosen.
  if (specular == 0 && diffuse_albedo.is_zero()) return {};
  return {total, specular * r.pdf + (1 - specular) * (wi.z * kInvPi)};
}

LobeValues Glossy::evaluate_lobes(Vec3 wo, Vec3 wi, const ShadingPoint& at) const {
  if (wo.z <= 0 || wi.z <= 0) return {};
  const Parts p = parts(*this, scaled_albedo(*this, at), ggx.reflect(wo, wi), wi, at);
  return {.diffuse = p.diffuse, .fresnel = p.specular, .diffraction = {}};
}

std::optional<BsdfSample> Glossy::sample(Vec3 wo, const BsdfRandom& u, const ShadingPoint& at) const {
  if (wo.z <= 0) return std::nullopt;
  const Float specular = specular_probability(scaled_albedo(*this, at), wo, at);
  const bool choose_specular = specular > 0 && (specular == 1 || u.lobe < specular);
  const Vec3 wi = choose_specular ? ggx.sample(wo, u.direction) : sample_cosine_hemisphere(u.direction);
  const BsdfValue value = evaluate(wo, wi, at);
  if (value.pdf <= 0) return std::nullopt;
  return BsdfSample{.wi = wi,
                    .weight = value.value_cos / value.pdf,
                    .pdf = value.pdf,
                    .lobe = choose_specular ? Lobe::kSpecular : Lobe::kDiffuse};
}

}  // namespace spectrace
