// SPDX-License-Identifier: Apache-2.0
#include "materials/coat_albedo.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/math/math.h"
#include "materials/fresnel.h"
#include "materials/microfacet.h"

namespace spectrace {

namespace {

// Nodes at equal steps of sqrt(cosθ), where the ratio changes most: near grazing, over cosines of about
// alpha.
constexpr std::size_t kCosines = 128;
// Facets a node's integral is made of: over half the turn around wo, whose other half mirrors it, and away
// from it.
constexpr int kAzimuths = 32, kTilts = 128;
// Between rows of indices this far apart, E is linear to 1e-5; a wider range has coarser ones, never more
// rows.
constexpr Float kEtaStep = Float(0.02);
constexpr std::size_t kMaxRows = 17;
// Nearer to 1 the Fresnel reflectance has lost its digits; the ratio has its limit there.
constexpr Float kLeastEta = Float(1.01);

Float cosine_of(std::size_t node) {
  const Float root = Float(node) / Float(kCosines - 1);
  return std::max(sqr(root), Float(1e-6));  // at 0 no facet is seen
}

/// E over the plane's Fresnel reflectance: the mean of F G2 / G1 over facets seen from there.
Float albedo_ratio(const Ggx& ggx, Float cosine, Float eta) {
  const Vec3 wo{safe_sqrt(1 - sqr(cosine)), 0, cosine};
  double sum = 0;
  for (int j = 0; j < kTilts; ++j) {
    // Steps shrink towards the steepest facets: where those begin to mirror below the horizon the integrand
    // falls to 0 within a share of about alpha² of them.
    const Float v = (Float(j) + Float(0.5)) / kTilts, rest = sqr(1 - v);
    const double share = 4 * double(rest * (1 - v)) / kTilts;
    for (int i = 0; i < kAzimuths; ++i) {
      const Vec2 u{(Float(i) + Float(0.5)) / (2 * kAzimuths), 1 - sqr(rest)};
      const Ggx::Reflection r = ggx.reflect(wo, ggx.sample(wo, u));
      if (r.pdf <= 0) continue;
      sum += share * double(fresnel_dielectric(r.cos_half, eta)) * double(r.value_cos / r.pdf);
    }
  }
  return static_cast<Float>(sum / kAzimuths / double(fresnel_dielectric(cosine, eta)));
}

}  // namespace

CoatAlbedo::CoatAlbedo(Float alpha, Float eta_min, Float eta_max) : eta_min_(eta_min) {
  SPECTRACE_CHECK(eta_min >= 1 && eta_max >= eta_min && eta_max <= kMaxCoatEta);
  if (eta_max > eta_min) {
    rows_ = std::min(static_cast<std::size_t>(std::ceil((eta_max - eta_min) / kEtaStep)) + 1, kMaxRows);
    eta_step_ = (eta_max - eta_min) / Float(rows_ - 1);
  }
  if (alpha > 0) tabulate(alpha);
  // 2 ∫ E c dc with c = t²: 4 ∫ E t³ dt, by midpoints.
  constexpr int kSteps = 2048;
  std::vector<float> averages;
  for (std::size_t row = 0; row < rows_; ++row) {
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
      const double t = (i + 0.5) / kSteps;
      const Float cosine = static_cast<Float>(t * t);
      sum += 4 * t * t * t * double(fresnel_dielectric(cosine, eta_of(row)) * ratio(row, cosine));
    }
    averages.push_back(static_cast<float>(sum / kSteps));
  }
  averages_ = std::move(averages);
}

void CoatAlbedo::tabulate(Float alpha) {
  std::vector<float> ratios;
  for (std::size_t row = 0; row < rows_; ++row) {
    for (std::size_t node = 0; node < kCosines; ++node) {
      ratios.push_back(static_cast<float>(
          albedo_ratio({alpha, alpha}, cosine_of(node), std::max(eta_of(row), kLeastEta))));
    }
  }
  ratios_ = std::move(ratios);
}

Float CoatAlbedo::eta_of(std::size_t row) const { return eta_min_ + eta_step_ * Float(row); }

CoatAlbedo::Rows CoatAlbedo::rows(Float eta) const {
  if (rows_ == 1) return {};
  const Float x = std::clamp((eta - eta_min_) / eta_step_, Float(0), Float(rows_ - 1));
  const auto first = std::min(static_cast<std::size_t>(x), rows_ - 2);
  return {first, first + 1, x - Float(first)};
}

Float CoatAlbedo::ratio(std::size_t row, Float cosine) const {
  if (ratios_.empty()) return 1;
  const Float x = std::min(std::sqrt(cosine), Float(1)) * Float(kCosines - 1);
  const auto node = std::min(static_cast<std::size_t>(x), kCosines - 2);
  const float* r = &ratios_[row * kCosines + node];
  return lerp(Float(r[0]), Float(r[1]), x - Float(node));
}

Float CoatAlbedo::at(Float cosine, Float eta) const {
  const Rows r = rows(eta);
  const Float first = ratio(r.first, cosine);
  const Float scale = r.weight == 0 ? first : lerp(first, ratio(r.second, cosine), r.weight);
  return fresnel_dielectric(cosine, eta) * scale;
}

Float CoatAlbedo::average(Float eta) const {
  const Rows r = rows(eta);
  return lerp(Float(averages_[r.first]), Float(averages_[r.second]), r.weight);
}

}  // namespace spectrace
