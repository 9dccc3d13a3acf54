// SPDX-License-Identifier: Apache-2.0
#include "materials/diffractive.h"

#include <algorithm>
#include <cmath>

#include "core/math/math.h"
#include "materials/lambert.h"

namespace spectrace {

namespace {

/// |ξi + ξo|² = (2 cosθd sinθh)².
Float xi_squared(Vec3 wo, Vec3 wi) { return sqr(wo.x + wi.x) + sqr(wo.y + wi.y); }

Float mean_density(const MicroRoughness& micro, Float xi2, const SampledWavelengths& lambda) {
  Float sum = 0;
  for (int k = 0; k < kLanes; ++k) sum += micro.density(xi2, lambda.lambda_nm(k));
  return sum / kLanes;
}

}  // namespace

Float MicroRoughness::diffracted(Float cos_theta, Float lambda_nm) const {
  return -std::expm1(-sqr(4 * kPi * rms_nm * cos_theta / lambda_nm));
}

Float MicroRoughness::density(Float xi_squared, Float lambda_nm) const {
  const Float scale = sqr(correlation_nm / lambda_nm);
  // ∫ 2π x (1 + scale x²)^(-s/2) dx = 2π / (scale (s - 2))
  return (exponent - 2) / (2 * kPi) * scale * std::pow(1 + scale * xi_squared, -exponent / 2);
}

Float MicroRoughness::sample_radius(Float u, Float lambda_nm) const {
  // The share within x is 1 - (1 + (b x / λ)²)^(1 - s/2).
  return lambda_nm / correlation_nm * safe_sqrt(std::pow(1 - u, 2 / (2 - exponent)) - 1);
}

Diffractive::Mix Diffractive::mix(Vec3 wo, const ShadingPoint& at) const {
  const SampledSpectrum specular = spectrace::reflectance(fresnel, wo.z, at.lambda) * specular_scale;
  Mix m{.diffuse_albedo = diffuse_albedo(wo, at)};
  m.diffuse = m.diffuse_albedo.average();
  for (int k = 0; k < kLanes; ++k) {
    const Float share = micro.diffracted(wo.z, at.lambda.lambda_nm(k));
    m.diffracted += specular[k] * share / kLanes;
    m.mirrored += specular[k] * (1 - share) / kLanes;
  }
  const Float sum = m.diffuse + m.mirrored + m.diffracted;
  m.diffuse = safe_div(m.diffuse, sum);
  m.mirrored = safe_div(m.mirrored, sum);
  m.diffracted = safe_div(m.diffracted, sum);
  return m;
}

LobeValues Diffractive::lobes(const SampledSpectrum& diffuse_albedo, const Ggx::Reflection& r, Vec3 wo,
                              Vec3 wi, const ShadingPoint& at) const {
  const auto [least, most] = std::minmax(wo.z, wi.z);
  const Float xi2 = xi_squared(wo, wi);
  SampledSpectrum mirrored, diffracted;
  for (int k = 0; k < kLanes; ++k) {
    mirrored[k] = (1 - micro.diffracted(most, at.lambda.lambda_nm(k))) * r.value_cos;
    diffracted[k] =
        micro.diffracted(least, at.lambda.lambda_nm(k)) * micro.density(xi2, at.lambda.lambda_nm(k)) * wi.z;
  }
  const SampledSpectrum f = spectrace::reflectance(fresnel, r.cos_half, at.lambda) * specular_scale;
  return {
      .diffuse = diffuse_albedo * (wi.z * kInvPi), .fresnel = f * mirrored, .diffraction = f * diffracted};
}

BsdfValue Diffractive::evaluate(const Mix& mix, Vec3 wo, Vec3 wi, const ShadingPoint& at) const {
  if (wi.z <= 0) return {};
  const Ggx::Reflection r = ggx.reflect(wo, wi);
  const Float diffracted_pdf =
      mix.diffracted > 0 ? mean_density(micro, xi_squared(wo, wi), at.lambda) * wi.z : Float(0);
  const Float pdf = mix.diffuse * wi.z * kInvPi + mix.mirrored * r.pdf + mix.diffracted * diffracted_pdf;
  if (pdf <= 0) return {};
  return {lobes(mix.diffuse_albedo, r, wo, wi, at).total(), pdf};
}

BsdfValue Diffractive::evaluate(Vec3 wo, Vec3 wi, const ShadingPoint& at) const {
  if (wo.z <= 0 || wi.z <= 0) return {};
  return evaluate(mix(wo, at), wo, wi, at);
}

LobeValues Diffractive::evaluate_lobes(Vec3 wo, Vec3 wi, const ShadingPoint& at) const {
  if (wo.z <= 0 || wi.z <= 0) return {};
  return lobes(reflectance.sample(at.lambda, at.uv, at.footprint) * diffuse_scale, ggx.reflect(wo, wi), wo,
               wi, at);
}

std::optional<BsdfSample> Diffractive::sample(Vec3 wo, const BsdfRandom& u, const ShadingPoint& at) const {
  if (wo.z <= 0) return std::nullopt;
  const Mix m = mix(wo, at);
  const bool choose_diffuse = m.diffuse > 0 && (m.diffuse == 1 || u.lobe < m.diffuse);
  Vec3 wi;
  if (choose_diffuse) {
    wi = sample_cosine_hemisphere(u.direction);
  } else if (u.lobe < m.diffuse + m.mirrored || m.diffracted <= 0) {
    wi = ggx.sample(wo, u.direction);
  } else {
    const Float rest =
        (u.lobe - m.diffuse - m.mirrored) / m.diffracted;  // in [0, 1], used again for the lane
    const int lane = std::clamp(static_cast<int>(rest * kLanes), 0, kLanes - 1);
    const Float radius = micro.sample_radius(u.direction.x, at.lambda.lambda_nm(lane)),
                phi = 2 * kPi * u.direction.y;
    if (!(radius < 2)) return std::nullopt;  // beyond the horizon of any wo
    wi = {radius * std::cos(phi) - wo.x, radius * std::sin(phi) - wo.y, 0};
    wi.z = safe_sqrt(1 - sqr(wi.x) - sqr(wi.y));
  }
  const BsdfValue value = evaluate(m, wo, wi, at);
  if (value.pdf <= 0) return std::nullopt;
  return BsdfSample{.wi = wi,
                    .weight = value.value_cos / value.pdf,
                    .pdf = value.pdf,
                    .lobe = choose_diffuse ? Lobe::kDiffuse : Lobe::kSpecular};
}

}  // namespace spectrace
