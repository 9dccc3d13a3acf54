// SPDX-License-Identifier: Apache-2.0
#include "materials/fresnel.h"

#include "core/math/math.h"

namespace spectrace {

namespace {

/// Products and quotients alone, without std::complex' care for infinities, which costs four times as much.
struct Complex {
  Float re = 0, im = 0;
};
Complex operator*(Float s, Complex z) { return {s * z.re, s * z.im}; }
Complex operator+(Complex a, Complex b) { return {a.re + b.re, a.im + b.im}; }
Complex operator-(Complex a, Complex b) { return {a.re - b.re, a.im - b.im}; }
Complex operator/(Complex a, Complex b) {
  const Float norm = sqr(b.re) + sqr(b.im);
  return {(a.re * b.re + a.im * b.im) / norm, (a.im * b.re - a.re * b.im) / norm};
}

/// The root with positive real and imaginary parts, `z.im` >= 0: waves that fade with depth.
Complex complex_sqrt(Complex z) {
  const Float norm = std::sqrt(sqr(z.re) + sqr(z.im));
  const Float larger = std::sqrt((norm + std::abs(z.re)) / 2);
  const Float smaller = safe_div(z.im, 2 * larger);
  return z.re >= 0 ? Complex{larger, smaller} : Complex{smaller, larger};
}

/// Airy's sum over the waves reflected inside a transparent film, for one polarisation: `top` is the
/// amplitude reflected at its upper face, `bottom` at its lower. Born & Wolf 1999, sec. 7.6, eq. 7, squared:
/// as a quotient of squares, which rounding cannot make negative.
Float film_reflectance(Float top, Complex bottom, Float cos_phase, Float sin_phase) {
  const Complex back{bottom.re * cos_phase - bottom.im * sin_phase,
                     bottom.re * sin_phase + bottom.im * cos_phase};
  const Float reflected = sqr(top + back.re) + sqr(back.im);
  const Float all = sqr(1 + top * back.re) + sqr(top * back.im);
  return all > 0 ? std::min(reflected / all, Float(1)) : Float(1);  // 0/0 at grazing, where both faces mirror
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
  return std::max((rs + rp) / 2, Float(0));  // an index near 1 leaves the rounding of either sign
}

SampledSpectrum fresnel_schlick(Float cos_i, const SampledSpectrum& f0) {
  const Float x = std::clamp(1 - cos_i, Float(0), Float(1));
  const Float x5 = sqr(sqr(x)) * x;
  return f0 * (1 - x5) + SampledSpectrum(x5);
}

Float fresnel_thin_film(Float cos_i, Float lambda_nm, Float film_eta, Float thickness_nm, Float base_eta,
                        Float base_k) {
  if (cos_i <= 0) return 1;
  if (thickness_nm == 0) return fresnel_conductor(cos_i, base_eta, base_k);
  const Float sin2 = std::max(1 - sqr(cos_i), Float(0));
  const Float n2_film = sqr(film_eta);
  const Complex n2_base{sqr(base_eta) - sqr(base_k), 2 * base_eta * base_k};
  // q = n cosθ = sqrt(n² - sin²θ0): the normal part of the wave vector over that of vacuum. With it the
  // amplitudes of Born & Wolf 1999, sec. 1.5.2, eqs. 21-21a hold for complex indices as well.
  const Float q_film = std::sqrt(n2_film - sin2);
  const Complex q_base = complex_sqrt({n2_base.re - sin2, n2_base.im});
  const Float top_s = (cos_i - q_film) / (cos_i + q_film);
  const Float top_p = (n2_film * cos_i - q_film) / (n2_film * cos_i + q_film);
  const Complex film{q_film, 0};
  const Complex bottom_s = (film - q_base) / (film + q_base);
  const Complex bottom_p = (q_film * n2_base - n2_film * q_base) / (q_film * n2_base + n2_film * q_base);
  const Float phase = 4 * kPi * thickness_nm / lambda_nm * q_film;  // there and back
  const Float cos_phase = std::cos(phase), sin_phase = std::sin(phase);
  return (film_reflectance(top_s, bottom_s, cos_phase, sin_phase) +
          film_reflectance(top_p, bottom_p, cos_phase, sin_phase)) /
         2;
}

Float fresnel_coated_dielectric(Float cos_i, bool outside, Float lambda_nm, Float base_eta, Float film_eta,
                                Float thickness_nm) {
  if (outside) return fresnel_thin_film(cos_i, lambda_nm, film_eta, thickness_nm, base_eta, 0);
  const Float sin2_outside = (1 - sqr(cos_i)) * sqr(base_eta);
  if (sin2_outside >= 1) return 1;
  return fresnel_thin_film(safe_sqrt(1 - sin2_outside), lambda_nm, film_eta, thickness_nm, base_eta, 0);
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
