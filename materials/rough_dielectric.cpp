// SPDX-License-Identifier: Apache-2.0
#include "materials/rough_dielectric.h"

#include "core/math/math.h"

namespace spectrace {

RoughDielectric::Lanes RoughDielectric::lanes(bool outside, const SampledWavelengths& lambda) const {
  Lanes lanes;
  lanes.eta = eta_.sample(lambda);
  lanes.count = varies_ && !lambda.secondary_terminated() ? kLanes : 1;
  lanes.outside = outside;
  for (int i = 0; !outside && i < kLanes; ++i) lanes.eta[i] = 1 / lanes.eta[i];
  if (film_) {
    lanes.film_eta = film_->eta.sample(lambda);
    for (int i = 0; i < kLanes; ++i) lanes.lambda_nm[i] = lambda.lambda_nm(i);
  }
  return lanes;
}

Float RoughDielectric::reflectance(const Lanes& lanes, int lane, Float cos_half) const {
  const Float eta = lanes.eta[lane];
  if (!film_) return fresnel_dielectric(cos_half, eta);
  return fresnel_coated_dielectric(cos_half, lanes.outside, lanes.lambda_nm[lane],
                                   lanes.outside ? eta : 1 / eta, lanes.film_eta[lane], film_->thickness_nm);
}

BsdfValue RoughDielectric::evaluate(const Lanes& lanes, Vec3 wo, Vec3 wi) const {
  BsdfValue result;
  const auto add = [&](int lane, Float share, Float value_cos, Float pdf) {
    result.value_cos[lane] = share * value_cos;
    result.pdf += share * pdf / Float(lanes.count);
  };
  if (wi.z > 0) {
    const Ggx::Reflection r = ggx_.reflect(wo, wi);
    for (int i = 0; i < lanes.count; ++i) {
      add(i, reflectance(lanes, i, r.cos_half), r.value_cos, r.pdf);
    }
  } else {
    for (int i = 0; i < lanes.count; ++i) {
      const Ggx::Refraction r = ggx_.refract(wo, wi, lanes.eta[i]);
      add(i, 1 - reflectance(lanes, i, r.cos_half), r.value_cos, r.pdf);
    }
  }
  if (!(result.pdf > 0)) return {};
  if (!varies_) result.value_cos = SampledSpectrum(result.value_cos[0]);
  return result;
}

BsdfValue RoughDielectric::evaluate(Vec3 wo, Vec3 wi, const ShadingPoint& at) const {
  if (wo.z == 0 || wi.z == 0) return {};
  const bool outside = wo.z > 0;
  // GGX knows no side: from within, both directions are turned about the origin.
  return outside ? evaluate(lanes(true, at.lambda), wo, wi) : evaluate(lanes(false, at.lambda), -wo, -wi);
}

LobeValues RoughDielectric::evaluate_lobes(Vec3 wo, Vec3 wi, const ShadingPoint& at) const {
  return {.diffuse = {}, .fresnel = evaluate(wo, wi, at).value_cos, .diffraction = {}};
}

std::optional<BsdfSample> RoughDielectric::sample(Vec3 wo, const BsdfRandom& u,
                                                  const ShadingPoint& at) const {
  if (wo.z == 0) return std::nullopt;
  const bool outside = wo.z > 0;
  const Vec3 above = outside ? wo : -wo;
  const Lanes l = lanes(outside, at.lambda);
  // The number for the lobe chooses the lane, and what is left of it the lobe.
  const Float scaled = u.lobe * Float(l.count);
  const int lane = std::min(static_cast<int>(scaled), l.count - 1);
  const Float eta = l.eta[lane];

  const Vec3 normal = ggx_.visible_normal(above, u.direction);
  const Float length2 = length_squared(normal);
  if (!(length2 > 0)) return std::nullopt;
  const Vec3 wm = normal / std::sqrt(length2);
  const Float cos_o = std::min(dot(above, wm), Float(1));
  if (!(cos_o > 0)) return std::nullopt;
  const Float reflected = reflectance(l, lane, cos_o);
  const bool reflects = reflected >= 1 || scaled - Float(lane) < reflected;
  Vec3 wi = wm * (2 * cos_o) - above;
  if (!reflects) {  // Snell's law; not beyond the critical angle, where all would have been reflected
    const Float cos_t = safe_sqrt(1 - (1 - sqr(cos_o)) / sqr(eta));
    wi = wm * (cos_o / eta - cos_t) - above / eta;
  }
  wi = normalize(wi);
  if (!(reflects ? wi.z > 0 : wi.z < 0)) return std::nullopt;
  const BsdfValue value = evaluate(l, above, wi);
  if (!(value.pdf > 0)) return std::nullopt;
  return BsdfSample{.wi = outside ? wi : -wi,
                    .weight = value.value_cos / value.pdf,
                    .pdf = value.pdf,
                    .lobe = Lobe::kSpecular,
                    .radiance_scale = reflects ? Float(1) : 1 / sqr(l.eta[0])};
}

}  // namespace spectrace
