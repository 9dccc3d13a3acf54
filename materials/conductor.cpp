// SPDX-License-Identifier: Apache-2.0
#include "materials/conductor.h"

namespace spectrace {

std::optional<BsdfSample> SmoothConductor::sample(Vec3 wo, const BsdfRandom&, const ShadingPoint& at) const {
  if (wo.z <= 0) return std::nullopt;
  return BsdfSample{.wi = {-wo.x, -wo.y, wo.z},
                    .weight = fresnel.reflectance(wo.z, at.lambda),
                    .pdf = 1,
                    .lobe = Lobe::kSpecular,
                    .is_delta = true};
}

BsdfValue RoughConductor::evaluate(Vec3 wo, Vec3 wi, const ShadingPoint& at) const {
  const Ggx::Reflection r = ggx.reflect(wo, wi);
  if (r.pdf <= 0) return {};
  return {fresnel.reflectance(r.cos_half, at.lambda) * r.value_cos, r.pdf};
}

LobeValues RoughConductor::evaluate_lobes(Vec3 wo, Vec3 wi, const ShadingPoint& at) const {
  return {.diffuse = {}, .fresnel = evaluate(wo, wi, at).value_cos, .diffraction = {}};
}

std::optional<BsdfSample> RoughConductor::sample(Vec3 wo, const BsdfRandom& u, const ShadingPoint& at) const {
  if (wo.z <= 0) return std::nullopt;
  const Vec3 wi = ggx.sample(wo, u.direction);
  const BsdfValue value = evaluate(wo, wi, at);
  if (value.pdf <= 0) return std::nullopt;
  return BsdfSample{
      .wi = wi, .weight = value.value_cos / value.pdf, .pdf = value.pdf, .lobe = Lobe::kSpecular};
}

}  // namespace spectrace
