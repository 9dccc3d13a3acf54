// SPDX-License-Identifier: Apache-2.0
#include "materials/microfacet.h"

#include "core/math/math.h"

namespace spectrace {

namespace {

/// sqrt(cos² + α² sin²) along w's azimuth: |wm-space length| of w. Smith's Λ = (stretch / cosθ - 1) / 2
/// (Heitz 2014, eq. 86), which every formula below uses in a form without division by a vanishing cosine.
Float stretch(const Ggx& g, Vec3 w) {
  return std::sqrt(sqr(g.alpha_x * w.x) + sqr(g.alpha_y * w.y) + sqr(w.z));
}

}  // namespace

Float Ggx::distribution(Vec3 wm) const {
  if (wm.z <= 0) return 0;
  // Heitz 2014, eq. 85.
  const Float e = sqr(wm.x / alpha_x) + sqr(wm.y / alpha_y) + sqr(wm.z);
  return 1 / (kPi * alpha_x * alpha_y * sqr(e));
}

Float Ggx::masking(Vec3 w) const { return w.z <= 0 ? Float(0) : 2 * w.z / (w.z + stretch(*this, w)); }

Ggx::Reflection Ggx::reflect(Vec3 wo, Vec3 wi) const {
  if (wo.z <= 0 || wi.z <= 0) return {};
  const Vec3 half = wo + wi;
  const Float half_length = length(half);
  const Float d = distribution(half / half_length);
  const Float stretch_o = stretch(*this, wo), stretch_i = stretch(*this, wi);
  Reflection r;
  r.cos_half = std::min(half_length / 2, Float(1));  // wo·wm, but exact at grazing and the same for both
  // D G2 / (4 cosθo) with G2 = 2 cosθi cosθo / (cosθo stretch_i + cosθi stretch_o): Heitz 2014, eq. 99.
  r.value_cos = d / (2 * (wo.z / wi.z * stretch_i + stretch_o));
  // D_visible / (4 wo·wm) with D_visible = G1 (wo·wm) D / cosθo: Heitz 2018, eqs. 1-3 and 17.
  r.pdf = d / (2 * (wo.z + stretch_o));
  return r;
}

Ggx::Refraction Ggx::refract(Vec3 wo, Vec3 wi, Float eta) const {
  if (!(wo.z > 0 && wi.z < 0)) return {};
  // Walter et al. 2007, eq. 16, turned to the side of wo.
  const Vec3 sum = wo + wi * eta;
  const Vec3 half = eta > 1 ? -sum : sum;
  const Float half2 = length_squared(half);
  if (!(half.z > 0) || !(half2 > 0)) return {};
  const Vec3 wm = half / std::sqrt(half2);
  const Float cos_o = dot(wo, wm), cos_i = dot(wi, wm);
  if (!(cos_o > 0 && cos_i < 0)) return {};  // seen or left through its back: ibid. eqs. 21 and 23
  Refraction r;
  r.cos_half = std::min(cos_o, Float(1));
  // D_visible |dωm/dωi|: Heitz 2018, eqs. 1-3; Walter et al. 2007, eq. 17, where the sum in the denominator
  // is the length of `half`.
  const Float visible = 2 * distribution(wm) * cos_o / (wo.z + stretch(*this, wo));
  r.pdf = visible * (sqr(eta) * -cos_i / half2);
  // Ibid. eq. 21 over that density leaves G1(wi) / eta²: masking and shadowing on the two sides of the
  // surface taken for independent (ibid. eq. 23).
  r.value_cos = r.pdf * masking(-wi) / sqr(eta);
  return r;
}

Vec3 Ggx::visible_normal(Vec3 wo, Vec2 u) const {
  // Stretched so that alpha = 1, the visible normals of the half ball are halfway between wo and the points
  // of a spherical cap: Dupuy & Benyoub 2023, listing 3. The same density as Heitz 2018.
  const Vec3 w = normalize({alpha_x * wo.x, alpha_y * wo.y, wo.z});
  const Float one_minus_z = u.y * (1 + w.z);
  const Float one_plus_z = (1 - u.y) * (1 + w.z) + (1 - w.z);
  const Float sin_theta = safe_sqrt(one_minus_z * one_plus_z);  // of the cap point, without cancellation
  const Float phi = 2 * kPi * u.x;
  const Vec3 h{sin_theta * std::cos(phi) + w.x, sin_theta * std::sin(phi) + w.y, (1 - u.y) * (1 + w.z)};
  return {alpha_x * h.x, alpha_y * h.y, h.z};
}

Vec3 Ggx::sample(Vec3 wo, Vec2 u) const {
  const Vec3 wm = visible_normal(wo, u);
  const Float wm2 = length_squared(wm);
  if (!(wm2 > 0)) return {0, 0, -1};  // u.y = 1 can land opposite to w: no facet
  return normalize(wm * (2 * dot(wo, wm) / wm2) - wo);
}

}  // namespace spectrace
