// SPDX-License-Identifier: Apache-2.0
#include "materials/fresnel.h"

#include <complex>

#include "core/math/math.h"

namespace spectrace {

namespace {

using Complex = std::complex<Float>;

/// Amplitude reflected between two media, for both polarisations. `q` = sqrt(n² - sin²θ0): the normal part of
/// the wave vector over that of vacuum. Born & Wolf 1999, sec. 1.5.2, eqs. 21-21a, with cosθ = q / n.
struct Amplitudes {
  Complex s, p;
};
Amplitudes interface_amplitudes(Complex n2_before, Complex q_before, Complex n2_after, Complex q_after) {
  return {(q_before - q_after) / (q_before + q_after),
          (n2_after * q_before - n2_before * q_after) / (n2_after * q_before + n2_before * q_after)};
}

/// Airy's sum over the waves reflected inside the film, for one polarisation. Born & Wolf 1999, sec. 7.6,
/// eq. 7.
Float film_reflectance(Complex top, Complex bottom, Complex round_trip) {
  return std::norm((top + bottom * round_trip) / (Float(1) + top * bottom * round_trip));
}

}  // namespace

Float fresnel_dielectric(Float cos_i, Float eta) {
  if (eta == 1) return 0;  // no interface: the quotients below would be 0/0 at grazing
  const Float sin2_t = (1 - sqr(cos_i)) / sqr(eta);
  if (sin2_t >= 1) return 1;
  const Float cos_t = safe_sqrt(1 - sin2_t);
  const Float s = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
  const Float p = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
  return (sqr(s) + sqr(p)) / 2;
}

Float fresnel_conductor(Float cos_i, Float eta, Float k) {
  if (k == 0) return fresnel_dielectric(cos_i, eta);
  // Born & Wolf 1999, sec. 14.2, eqs. 13-15 squared: q = sqrt((η + ik)² - sin²θ) = a + ib without complex
  // numbers.
  const Float cos2 = sqr(cos_i), sin2 = std::max(1 - cos2, Float(0));
  const Float re = sqr(eta) - sqr(k) - sin2;
  const Float q2 = std::sqrt(sqr(re) + sqr(2 * eta * k));  // a² + b²
  const Float two_a_cos = 2 * cos_i * safe_sqrt((q2 + re) / 2);
  const Float rs = (q2 + cos2 - two_a_cos) / (q2 + cos2 + two_a_cos);
  const Float even = cos2 * q2 + sqr(sin2), odd = two_a_cos * sin2;
  const Float rp = rs * (even - odd) / (even + odd);
  return (rs + rp) / 2;
}

SampledSpectrum fresnel_schlick(Float cos_i, const SampledSpectrum& f0) {
  const Float x = std::clamp(1 - cos_i, Float(0), Float(1));
  const Float x5 = sqr(sqr(x)) * x;
  return f0 * (1 - x5) + SampledSpectrum(x5);
}

Float fresnel_thin_film(Float cos_i, Float lambda_nm, Float film_eta, Float thickness_nm, Float base_eta,
                        Float base_k) {
  if (cos_i <= 0) return 1;
  const Float sin2 = std::max(1 - sqr(cos_i), Float(0));
  const Complex n2_film = sqr(film_eta), n2_base = sqr(Complex(base_eta, base_k));
  // The principal root has a positive imaginary part where there is one: waves that fade with depth.
  const Complex q_film = std::sqrt(n2_film - sin2), q_base = std::sqrt(n2_base - sin2);
  const Amplitudes top = interface_amplitudes(1, cos_i, n2_film, q_film);
  const Amplitudes bottom = interface_amplitudes(n2_film, q_film, n2_base, q_base);
  const Complex round_trip = std::exp(Complex(0, 4 * kPi * thickness_nm / lambda_nm) * q_film);
  return (film_reflectance(top.s, bottom.s, round_trip) + film_reflectance(top.p, bottom.p, round_trip)) / 2;
}

SampledSpectrum ConductorFresnel::reflectance(Float cos_i, const SampledWavelengths& lambda) const {
  const SampledSpectrum n = eta.sample(lambda), kappa = k.sample(lambda);
  SampledSpectrum result;
  if (film) {
    const SampledSpectrum film_n = film->eta.sample(lambda);
    for (int i = 0; i < kLanes; ++i) {
      result[i] =
          fresnel_thin_film(cos_i, lambda.lambda_nm(i), film_n[i], film->thickness_nm, n[i], kappa[i]);
    }
  } else {
    for (int i = 0; i < kLanes; ++i) result[i] = fresnel_conductor(cos_i, n[i], kappa[i]);
  }
  return result;
}

SampledSpectrum SchlickFresnel::reflectance(Float cos_i, const SampledWavelengths& lambda) const {
  return fresnel_schlick(cos_i, f0.sample(lambda));
}

SampledSpectrum reflectance(const SpecularFresnel& fresnel, Float cos_i, const SampledWavelengths& lambda) {
  return std::visit([&](const auto& f) { return f.reflectance(cos_i, lambda); }, fresnel);
}

}  // namespace spectrace
