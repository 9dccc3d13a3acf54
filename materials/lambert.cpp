// SPDX-License-Identifier: Apache-2.0
#include "materials/lambert.h"

#include "core/math/concentric_disk.h"
#include "core/math/math.h"

namespace spectrace {

Vec3 sample_cosine_hemisphere(Vec2 u) {
  const Vec2 disk = concentric_disk(u);
  return {disk.x, disk.y, safe_sqrt(1 - sqr(disk.x) - sqr(disk.y))};
}

BsdfValue Lambert::evaluate(Vec3 wo, Vec3 wi, const ShadingPoint& at) const {
  if (wo.z <= 0 || wi.z <= 0) return {};
  const Float pdf = wi.z * kInvPi;
  return {reflectance.sample(at.lambda, at.uv, at.footprint) * pdf, pdf};
}

LobeValues Lambert::evaluate_lobes(Vec3 wo, Vec3 wi, const ShadingPoint& at) const {
  return {.diffuse = evaluate(wo, wi, at).value_cos, .fresnel = {}, .diffraction = {}};
}

std::optional<BsdfSample> Lambert::sample(Vec3 wo, const BsdfRandom& u, const ShadingPoint& at) const {
  if (wo.z <= 0) return std::nullopt;
  const Vec3 wi = sample_cosine_hemisphere(u.direction);
  const SampledSpectrum albedo = reflectance.sample(at.lambda, at.uv, at.footprint);
  if (wi.z <= 0 || albedo.is_zero()) return std::nullopt;
  return BsdfSample{.wi = wi, .weight = albedo, .pdf = wi.z * kInvPi, .lobe = Lobe::kDiffuse};
}

}  // namespace spectrace
