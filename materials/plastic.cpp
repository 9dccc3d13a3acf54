// SPDX-License-Identifier: Apache-2.0
#include "materials/plastic.h"

#include "core/math/math.h"
#include "materials/fresnel.h"
#include "materials/lambert.h"

namespace spectrace {

namespace {

/// Of a coat whose index varies with wavelength.
std::shared_ptr<const CoatAlbedo> albedo_of(const Spectrum& eta, Float alpha) {
  const Float low = -eta.scaled(-1).max_over({}), high = eta.max_over({});
  return std::make_shared<const CoatAlbedo>(alpha, std::clamp(low, Float(1), kMaxCoatEta),
                                            std::clamp(high, Float(1), kMaxCoatEta));
}

}  // namespace

Plastic::Plastic(Texture reflectance, Spectrum eta, Float alpha)
    : reflectance_(std::move(reflectance)),
      eta_(std::move(eta)),
      alpha_(alpha),
      ggx_{alpha, alpha},
      albedo_(albedo_of(eta_, alpha)) {}

Plastic::View Plastic::view(Vec3 wo, const ShadingPoint& at) const {
  View v;
  v.eta = eta_.sample(at.lambda);
  const SampledSpectrum rho = reflectance_.sample(at.lambda, at.uv, at.footprint);
  for (int i = 0; i < kLanes; ++i) {
    v.coat_albedo[i] = albedo_->at(wo.z, v.eta[i]);
    const Float into = 1 - albedo_->average(v.eta[i]);  // of diffuse light from outside
    const Float out = into / sqr(v.eta[i]);             // of diffuse light from within: 1 - F_in
    v.diffuse_part[i] = (1 - v.coat_albedo[i]) / sqr(v.eta[i]) * rho[i] / (1 - rho[i] * (1 - out));
    v.diffuse_albedo[i] = v.diffuse_part[i] * into;
  }
  const Float coat = v.coat_albedo.average(), diffuse = v.diffuse_albedo.average();
  v.coat_probability = safe_div(coat, coat + diffuse);
  return v;
}

SampledSpectrum Plastic::diffuse(const View& v, Vec3 wi) const {
  SampledSpectrum result;
  for (int i = 0; i < kLanes; ++i) {
    result[i] = v.diffuse_part[i] * (1 - albedo_->at(wi.z, v.eta[i])) * (wi.z * kInvPi);
  }
  return result;
}

SampledSpectrum Plastic::coat(const View& v, const Ggx::Reflection& r) const {
  SampledSpectrum result;
  for (int i = 0; i < kLanes; ++i) result[i] = fresnel_dielectric(r.cos_half, v.eta[i]) * r.value_cos;
  return result;
}

BsdfValue Plastic::evaluate(const View& v, Vec3 wo, Vec3 wi) const {
  BsdfValue result{diffuse(v, wi), (1 - v.coat_probability) * (wi.z * kInvPi)};
  if (has_delta_lobe()) return result;
  const Ggx::Reflection r = ggx_.reflect(wo, wi);
  result.value_cos += coat(v, r);
  result.pdf += v.coat_probability * r.pdf;
  return result;
}

BsdfValue Plastic::evaluate(Vec3 wo, Vec3 wi, const ShadingPoint& at) const {
  if (!(wo.z > 0 && wi.z > 0)) return {};
  return evaluate(view(wo, at), wo, wi);
}

LobeValues Plastic::evaluate_lobes(Vec3 wo, Vec3 wi, const ShadingPoint& at) const {
  if (!(wo.z > 0 && wi.z > 0)) return {};
  const View v = view(wo, at);
  LobeValues lobes{.diffuse = diffuse(v, wi), .fresnel = {}};
  if (!has_delta_lobe()) lobes.fresnel = coat(v, ggx_.reflect(wo, wi));
  return lobes;
}

std::optional<BsdfSample> Plastic::sample(Vec3 wo, const BsdfRandom& u, const ShadingPoint& at) const {
  if (!(wo.z > 0)) return std::nullopt;
  const View v = view(wo, at);
  const Float p = v.coat_probability;
  const bool choose_coat = p > 0 && (p >= 1 || u.lobe < p);
  if (choose_coat && has_delta_lobe()) {
    return BsdfSample{.wi = {-wo.x, -wo.y, wo.z},
                      .weight = v.coat_albedo / p,
                      .pdf = p,
                      .lobe = Lobe::kSpecular,
                      .is_delta = true};
  }
  const Vec3 wi = choose_coat ? ggx_.sample(wo, u.direction) : sample_cosine_hemisphere(u.direction);
  if (!(wi.z > 0)) return std::nullopt;
  const BsdfValue value = evaluate(v, wo, wi);
  if (!(value.pdf > 0)) return std::nullopt;
  return BsdfSample{.wi = wi,
                    .weight = value.value_cos / value.pdf,
                    .pdf = value.pdf,
                    .lobe = choose_coat ? Lobe::kSpecular : Lobe::kDiffuse};
}

}  // namespace spectrace
