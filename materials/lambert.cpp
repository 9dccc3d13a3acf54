// SPDX-License-Identifier: Apache-2.0
#include "materials/lambert.h"

#include "core/math/concentric_disk.h"
#include "core/math/math.h"

namespace spectrace {

Vec3 sample_cosine_hemisphere(Vec2 u) {
  const Vec2 disk = concentric_disk(u);
  return {disk.x, disk.y, safe_sqrt(1 - sqr(disk.x) - sqr(disk.y))};
}

namespace {

BsdfValue value_towards(Vec3 wi, const SampledSpectrum& albedo) {
  if (wi.z <= 0) return {};
  const Float pdf = wi.z * kInvPi;
  return {albedo * pdf, pdf};
}

std::optional<BsdfSample> draw(Vec2 u, const SampledSpectrum& albedo) {
  const Vec3 wi = sample_cosine_hemisphere(u);
  if (wi.z <= 0 || albedo.is_zero()) return std::nullopt;
  return BsdfSample{.wi = wi, .weight = albedo, .pdf = wi.z * kInvPi, .lobe = Lobe::kDiffuse};
}

}  // namespace

BsdfValue Lambert::evaluate(Vec3 wo, Vec3 wi, const ShadingPoint& at) const {
  if (wo.z <= 0 || wi.z <= 0) return {};
  return value_towards(wi, reflectance.sample(at.lambda, at.uv, at.footprint));
}

LobeValues Lambert::evaluate_lobes(Vec3 wo, Vec3 wi, const ShadingPoint& at) const {
  return {.diffuse = evaluate(wo, wi, at).value_cos, .fresnel = {}, .diffraction = {}};
}

std::optional<BsdfSample> Lambert::sample(Vec3 wo, const BsdfRandom& u, const ShadingPoint& at) const {
  if (wo.z <= 0) return std::nullopt;
  return draw(u.direction, reflectance.sample(at.lambda, at.uv, at.footprint));
}

Scattering Lambert::scatter(Vec3 wo, const Vec3* light, const BsdfRandom& u, const ShadingPoint& at) const {
  if (wo.z <= 0) return {};
  const SampledSpectrum albedo = reflectance.sample(at.lambda, at.uv, at.footprint);
  return {light != nullptr ? value_towards(*light, albedo) : BsdfValue{}, draw(u.direction, albedo)};
}

}  // namespace spectrace
