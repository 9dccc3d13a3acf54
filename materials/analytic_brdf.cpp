// SPDX-License-Identifier: Apache-2.0
#include "materials/analytic_brdf.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/base/error.h"
#include "core/math/math.h"
#include "materials/lambert.h"

namespace spectrace {
namespace {

// Neither of two lobes is chosen less often: energies are estimates, and the lobe drawn has the mean
// roughness of all wavelengths, so that one of them may send light where it does not reach. Weights stay
// below 1 / 0.2 of the other lobe's.
constexpr Float kLeastShare = Float(0.2);

/// G(θ) / (2 cosθ) of eq. 15: bounded by 1/a where G and cosθ both vanish.
double masking_over_cosine(double cosine, double a2) {
  return 1 / (cosine + std::sqrt(cosine * cosine + a2 * (1 - cosine * cosine)));
}

}  // namespace

double analytic_specular(const AnalyticParameters& p, double cos_h, double cos_d, double cos_i,
                         double cos_o) {
  const double fresnel = p.f_0 + (1 - p.f_0) * std::pow(1 - cos_d, 5);  // eq. 13
  const double a2 = p.alpha * p.alpha, cos2 = cos_h * cos_h;
  const double t = a2 * cos2 + (1 - cos2);  // (a² - 1) cos² + 1 without cancellation
  const double ndf = a2 / (kPi64 * t * t);  // eq. 14
  return p.rho_0 * fresnel * ndf * masking_over_cosine(cos_i, a2) * masking_over_cosine(cos_o, a2);
}

AnalyticBrdf::AnalyticBrdf(SpectralAxis axis, const std::vector<float>& parameters) : axis_(std::move(axis)) {
  const std::size_t n = axis_.size();
  SPECTRACE_CHECK(parameters.size() == 4 * n);
  auto at = std::make_shared<std::vector<AnalyticParameters>>(n);
  double log_alpha = 0;
  for (std::size_t k = 0; k < n; ++k) {
    (*at)[k] = {.albedo_d = double(parameters[k]),
                .rho_0 = double(parameters[n + k]),
                .f_0 = double(parameters[2 * n + k]),
                .alpha = double(parameters[3 * n + k])};
    log_alpha += std::log((*at)[k].alpha) / double(n);
    is_specular_ = is_specular_ || (*at)[k].rho_0 > 0;
    rho_0_.push_back(float((*at)[k].rho_0));
    rho_0_f_0_.push_back(float((*at)[k].rho_0 * (*at)[k].f_0));
  }
  albedo_d_.assign(parameters.begin(), parameters.begin() + std::ptrdiff_t(n));
  const Float alpha = std::clamp(Float(std::exp(log_alpha)), kMinAlpha, Float(1));
  lobe_ = {alpha, alpha};
  at_ = std::move(at);
}

SampledSpectrum AnalyticBrdf::specular(Vec3 wo, Vec3 wi, const SpectralAxis::Lookup& lookup) const {
  const Vec3 sum = wo + wi;
  const Float norm = length(sum);  // 2 cosθ_d
  if (!is_specular_ || !(norm > 0)) return {};
  const auto value = [&](std::size_t k) {
    return Float(
        analytic_specular((*at_)[k], double(sum.z / norm), double(norm) / 2, double(wi.z), double(wo.z)));
  };
  if (axis_.is_rgb()) {
    const std::array<float, 3> rgb{float(value(0)), float(value(1)), float(value(2))};
    return lookup.apply(rgb.data());
  }
  SampledSpectrum result;  // values between wavelengths, not parameters: what a table would hold
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    const Float fraction = lookup.fraction[lane];
    result[int(lane)] =
        (1 - fraction) * value(lookup.index[lane]) + fraction * value(lookup.index[lane] + lookup.upper);
  }
  return result;
}

Float AnalyticBrdf::specular_share(Vec3 wo, const SpectralAxis::Lookup& lookup) const {
  if (!is_specular_) return 0;
  // Eq. 13 with wo's angle for θd, and a GGX that loses nothing to masking.
  const Float s = 1 - wo.z, schlick = sqr(sqr(s)) * s;
  const Float mirrored =
      lerp(lookup.apply(rho_0_f_0_.data()).average(), lookup.apply(rho_0_.data()).average(), schlick);
  const Float diffuse = lookup.apply(albedo_d_.data()).average();
  return std::clamp(safe_div(mirrored, mirrored + diffuse), kLeastShare, 1 - kLeastShare);
}

Float AnalyticBrdf::pdf(Vec3 wo, Vec3 wi, Float share) const {
  const Float cosine = wi.z * kInvPi;
  return share > 0 ? share * lobe_.reflect(wo, wi).pdf + (1 - share) * cosine : cosine;
}

BsdfValue AnalyticBrdf::evaluate(Vec3 wo, Vec3 wi, const ShadingPoint& at) const {
  if (!(wo.z > 0 && wi.z > 0)) return {};
  return {.value_cos = evaluate_lobes(wo, wi, at).total(),
          .pdf = pdf(wo, wi, specular_share(wo, axis_.lookup(at.lambda)))};
}

LobeValues AnalyticBrdf::evaluate_lobes(Vec3 wo, Vec3 wi, const ShadingPoint& at) const {
  if (!(wo.z > 0 && wi.z > 0)) return {};
  const SpectralAxis::Lookup lookup = axis_.lookup(at.lambda);
  return {.diffuse = lookup.apply(albedo_d_.data()) * (wi.z * kInvPi),
          .fresnel = specular(wo, wi, lookup) * wi.z};
}

std::optional<BsdfSample> AnalyticBrdf::sample(Vec3 wo, const BsdfRandom& u, const ShadingPoint& at) const {
  if (!(wo.z > 0)) return std::nullopt;
  const bool is_specular = u.lobe < specular_share(wo, axis_.lookup(at.lambda));
  const Vec3 wi = is_specular ? lobe_.sample(wo, u.direction) : sample_cosine_hemisphere(u.direction);
  const BsdfValue value = evaluate(wo, wi, at);
  if (!std::isnormal(value.pdf)) return std::nullopt;  // 1 / pdf overflows below the normal numbers
  return BsdfSample{.wi = wi,
                    .weight = value.value_cos / value.pdf,
                    .pdf = value.pdf,
                    .lobe = is_specular ? Lobe::kSpecular : Lobe::kDiffuse};
}

}  // namespace spectrace
