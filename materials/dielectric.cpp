// SPDX-License-Identifier: Apache-2.0
#include "materials/dielectric.h"

#include "core/math/math.h"

namespace spectrace {

std::optional<BsdfSample> Dielectric::sample(Vec3 wo, const BsdfRandom& u, const ShadingPoint& at) const {
  if (wo.z == 0) return std::nullopt;
  const bool outside = wo.z > 0;
  const Float cos_o = std::min(std::abs(wo.z), Float(1));
  SampledSpectrum relative_eta;  // index beyond the interface over that on wo's side
  SampledSpectrum reflected;
  const SampledSpectrum interior = eta.sample(at.lambda);
  const SampledSpectrum film_eta = film ? film->eta.sample(at.lambda) : SampledSpectrum(1);
  for (int i = 0; i < kLanes; ++i) {
    relative_eta[i] = outside ? interior[i] : 1 / interior[i];
    reflected[i] = film ? fresnel_coated_dielectric(cos_o, outside, at.lambda.lambda_nm(i), interior[i],
                                                    film_eta[i], film->thickness_nm)
                        : fresnel_dielectric(cos_o, relative_eta[i]);
  }
  const bool by_mean = film && !at.lambda.secondary_terminated();
  const Float probability = by_mean ? reflected.average() : reflected[0];
  if (probability >= 1 || u.lobe < probability) {
    return BsdfSample{.wi = {-wo.x, -wo.y, wo.z},
                      .weight = reflected / probability,
                      .pdf = probability,
                      .lobe = Lobe::kSpecular,
                      .is_delta = true};
  }
  if (reflected[0] >= 1) return std::nullopt;  // of lanes that refract where the hero does not
  // Snell's law.
  const Float eta_hero = relative_eta[0];
  const Float cos_t = safe_sqrt(1 - (1 - sqr(cos_o)) / sqr(eta_hero));
  const Vec3 wi = normalize({-wo.x / eta_hero, -wo.y / eta_hero, outside ? -cos_t : cos_t});
  SampledSpectrum weight(1 / sqr(eta_hero));  // (1 - F) / pdf = 1, times (η_o / η_i)²
  for (int i = 0; film && i < kLanes; ++i) weight[i] *= (1 - reflected[i]) / (1 - probability);
  return BsdfSample{.wi = wi,
                    .weight = weight,
                    .pdf = 1 - probability,
                    .lobe = Lobe::kSpecular,
                    .is_delta = true,
                    .is_dispersive = !eta.is_constant(),
                    .radiance_scale = 1 / sqr(eta_hero)};
}

}  // namespace spectrace
