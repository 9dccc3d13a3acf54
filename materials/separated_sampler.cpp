// SPDX-License-Identifier: Apache-2.0
#include "materials/separated_sampler.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/math/math.h"
#include "materials/half_difference.h"

namespace spectrace {
namespace {

constexpr int kNodesU = 64, kNodesV = 32;
// ln of the ratio between the coarsest and the finest step of 1 - cosθ_h: the first node lies at 0.04
// degrees, below the table's own first step, and each later one 11 % further out.
constexpr Float kLogRange = Float(13.815510557964274);  // ln 1e6
constexpr Float kLogFloor = Float(1e-6);                // 1 / (e^kLogRange - 1), to 1e-6 of itself

/// Elevations of wo [deg] with a density of their own: dense where the horizon cuts the lobe.
constexpr std::array<Float, 24> kThetaNodesDeg{0,  5,           10, 15, 20, 25, 30,          35,
                                               40, 45,          50, 55, 60, 65, 70,          75,
                                               80, Float(82.5), 85, 87, 88, 89, Float(89.5), 90};

std::array<Float, kThetaNodesDeg.size()> theta_nodes_rad() {
  std::array<Float, kThetaNodesDeg.size()> nodes{};
  std::transform(kThetaNodesDeg.begin(), kThetaNodesDeg.end(), nodes.begin(), degrees_to_radians);
  return nodes;
}

/// The node at or below each half degree, and never the last one: all nodes lie on half degrees, so that no
/// search is needed.
constexpr auto kNodeAtHalfDegree = [] {
  std::array<std::uint8_t, 181> lower{};
  for (std::size_t i = 0, node = 0; i < lower.size(); ++i) {
    if (node + 2 < kThetaNodesDeg.size() && kThetaNodesDeg[node + 1] * 2 <= Float(i)) ++node;
    lower[i] = static_cast<std::uint8_t>(node);
  }
  return lower;
}();

/// z = 1 - cosθ_h as a function of u, its inverse, and dz/du.
Float z_of_u(Float u) { return std::min(kLogFloor * std::expm1(kLogRange * u), Float(1)); }
Float u_of_z(Float z) { return std::min(std::log(1 + z * (1 / kLogFloor)) * (1 / kLogRange), Float(1)); }
Float dz_du(Float z) { return kLogRange * (z + kLogFloor); }

/// Half vector of azimuth phi relative to wo's plane of incidence, which is the xz-plane.
Vec3 half_vector(Float z, Float phi) {
  const Float sin_theta = safe_sqrt(z * (2 - z));
  return {sin_theta * std::cos(phi), sin_theta * std::sin(phi), 1 - z};
}

Vec3 reflect(Vec3 wo, Vec3 h) { return 2 * dot(wo, h) * h - wo; }

}  // namespace

SeparatedSampler::SeparatedSampler(const SeparatedSource& source, SeparationModel model) {
  std::visit([&](const auto& tables) { tabulate(*tables, model); }, source);
}

template <typename Tables>
void SeparatedSampler::tabulate(const Tables& tables, SeparationModel model) {
  axis_size_ = tables.axis.size();
  empty_ = !has_specular(tables, model);
  if (empty_) return;
  const auto theta_o = theta_nodes_rad();
  constexpr std::array<Float, 1> kNoSecondParameter{0};
  std::vector<Float> density(theta_o.size() * kNodesU * kNodesV);
  std::vector<double> row(axis_size_), sum(axis_size_);
  albedo_.resize(theta_o.size() * axis_size_);

  for (std::size_t t = 0; t < theta_o.size(); ++t) {
    const Vec3 wo{std::sin(theta_o[t]), 0, t + 1 < theta_o.size() ? std::cos(theta_o[t]) : Float(0)};
    std::fill(sum.begin(), sum.end(), 0.0);
    for (int i = 0; i < kNodesU; ++i) {
      const Float z = z_of_u(Float(i) / (kNodesU - 1));
      for (int j = 0; j < kNodesV; ++j) {
        const Vec3 h = half_vector(z, kPi * j / (kNodesV - 1));
        const Float cos_d = dot(wo, h);
        const Vec3 wi = reflect(wo, h);
        if (cos_d <= 0 || wi.z <= 0) continue;
        const GridPoint point = tables.grid.locate(to_half_difference(wo, wi));
        const Float q = specular_at(tables, point);
        spectral_row(tables, model, point, row);
        double mean = 0;
        for (double s : row) mean += s / axis_size_;
        // Density over (u, v) of the half vector: dω_i = 4 (wo·h) dω_h, dω_h = dz dφ.
        const double base = double(q) * wi.z / (wi.z + wo.z) * 4 * cos_d * dz_du(z);
        density[(t * kNodesU + i) * kNodesV + j] = Float(base * mean);
        // Trapezoid rule over u in [0, 1] and φ in [-π, π].
        const double edge =
            (i == 0 || i == kNodesU - 1 ? 0.5 : 1.0) * (j == 0 || j == kNodesV - 1 ? 0.5 : 1.0);
        const double area = edge * 2 * double(kPi) / ((kNodesU - 1) * (kNodesV - 1));
        for (std::size_t k = 0; k < axis_size_; ++k) sum[k] += area * base * row[k];
      }
    }
    std::copy(sum.begin(), sum.end(), albedo_.begin() + std::ptrdiff_t(t * axis_size_));
  }
  warp_ = Warp2D(theta_o, kNoSecondParameter, kNodesV, kNodesU, density, true);
  density_.reserve(density.size());
  for (const Float theta : theta_o) {
    for (int i = 0; i < kNodesU; ++i) {
      for (int j = 0; j < kNodesV; ++j) {
        density_.push_back(warp_.eval({double(j) / (kNodesV - 1), double(i) / (kNodesU - 1)}, {.p0 = theta}));
      }
    }
  }
}

std::optional<Vec3> SeparatedSampler::sample(Vec3 wo, Elevation at, Vec2 u) const {
  // The lobe is even in the azimuth: the first bit of u.x picks the side.
  const Float side = u.x < Float(0.5) ? Float(1) : Float(-1);
  u.x = std::min(u.x < Float(0.5) ? 2 * u.x : 2 * u.x - 1, Float(1));
  const Vec2 position = warp_.sample(u, slices(at)).position;
  const Vec3 local = half_vector(z_of_u(position.y), side * kPi * position.x);

  const Float sin_o = std::hypot(wo.x, wo.y);
  const Vec2 x = sin_o > 0 ? Vec2{wo.x / sin_o, wo.y / sin_o} : Vec2{1, 0};
  const Vec3 h{x.x * local.x - x.y * local.y, x.y * local.x + x.x * local.y, local.z};
  if (dot(wo, h) <= 0) return std::nullopt;
  const Vec3 wi = normalize(reflect(wo, h));
  if (!(wi.z > 0)) return std::nullopt;
  return wi;
}

SeparatedSampler::Elevation SeparatedSampler::elevation(double theta_o_rad) {
  const Float degrees = radians_to_degrees(static_cast<Float>(theta_o_rad));
  const std::size_t half_degrees =
      std::min(static_cast<std::size_t>(2 * degrees), kNodeAtHalfDegree.size() - 1);
  const std::uint32_t lower = kNodeAtHalfDegree[half_degrees];
  const Float first = kThetaNodesDeg[lower], step = kThetaNodesDeg[lower + 1] - first;
  return {.lower = lower, .fraction = std::clamp((degrees - first) / step, Float(0), Float(1))};
}

Warp2D::Blend SeparatedSampler::slices(Elevation at) {
  Warp2D::Blend blend;
  blend.slice = {at.lower, at.lower + 1};
  blend.weight = {1 - at.fraction, at.fraction};
  blend.count = 2;
  return blend;
}

/// warp_.eval({v, u}, slices(at)) to float rounding; u and v in [0, 1].
Float SeparatedSampler::density(Float u, Float v, Elevation at) const {
  const Float y = u * (kNodesU - 1), x = v * (kNodesV - 1);
  const int i = std::min(static_cast<int>(y), kNodesU - 2), j = std::min(static_cast<int>(x), kNodesV - 2);
  const Float along_u = y - Float(i), along_v = x - Float(j);
  const auto bilinear = [&](const Float* p) {
    return lerp(lerp(p[0], p[1], along_v), lerp(p[kNodesV], p[kNodesV + 1], along_v), along_u);
  };
  const Float* const lower = &density_[(std::size_t(at.lower) * kNodesU + i) * kNodesV + j];
  return lerp(bilinear(lower), bilinear(lower + kNodesU * kNodesV), at.fraction);
}

Float SeparatedSampler::pdf(const PairGeometry& pair, Elevation at) const {
  const auto z = static_cast<Float>(pair.z_h), v = static_cast<Float>(pair.phi_h) * kInvPi;
  // dω_i = 4 cosθ_d dω_h, and the density is that of one side: φ in [0, π] stands for both.
  return safe_div(density(u_of_z(z), std::min(v, Float(1)), at),
                  8 * kPi * dz_du(z) * static_cast<Float>(pair.cos_d));
}

SampledSpectrum SeparatedSampler::albedo(Elevation at, const SpectralAxis::Lookup& lookup) const {
  const float* const row = &albedo_[at.lower * axis_size_];
  return (1 - at.fraction) * lookup.apply(row) + at.fraction * lookup.apply(row + axis_size_);
}

}  // namespace spectrace
