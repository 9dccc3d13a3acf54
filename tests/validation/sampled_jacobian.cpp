// SPDX-License-Identifier: Apache-2.0
#include "tests/validation/sampled_jacobian.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

namespace spectrace::test {

namespace {

/// Half the distance of the nearer neighbours. Unit vectors of single precision so far apart tell the width
/// of the narrowest lobe (0.001) to 2^-24 / (0.001 · 2^-6) = 0.4 %.
constexpr double kStep = 0x1p-7;
/// Directions nearer than this are one: single precision.
constexpr Float kSame = Float(1e-6);

struct Derivative {
  double x, y, z;
};

/// Of four places in a row, at -2, -1, 1 and 2 steps: what bends the map cancels up to the fourth order.
Derivative derivative(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  const auto along = [](double before2, double before, double after, double after2) {
    return (8 * (after - before) - (after2 - before2)) / (12 * kStep);
  };
  return {along(a.x, b.x, c.x, d.x), along(a.y, b.y, c.y, d.y), along(a.z, b.z, c.z, d.z)};
}

double cross_length(Derivative a, Derivative b) {
  return std::hypot(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}

/// Length of the intervals of u.lobe that draw the same direction; those shorter than a 64th may be missed.
double share_of_same(const std::function<std::optional<Vec3>(double)>& draw, Vec3 wi) {
  const auto is_same = [&](double x) {
    const std::optional<Vec3> other = draw(x);
    return other && length(*other - wi) < kSame;
  };
  constexpr int kScan = 64, kHalvings = 16;
  double share = 0;
  for (int i = 0; i < kScan; ++i) {
    double low = double(i) / kScan, high = double(i + 1) / kScan;
    const bool same_low = is_same(low), same_high = is_same(std::min(high, 1 - 0x1p-24));
    if (same_low && same_high) share += high - low;
    if (same_low == same_high) continue;
    const double begin = low, end = high;
    for (int k = 0; k < kHalvings; ++k) {
      const double middle = (low + high) / 2;
      (is_same(middle) == same_low ? low : high) = middle;
    }
    share += same_low ? low - begin : end - low;
  }
  return share;
}

}  // namespace

std::optional<LobeDensity> density_by_differences(const Material& material, Vec3 wo, BsdfRandom u,
                                                  const ShadingPoint& at) {
  constexpr double kMargin = 2 * kStep;
  const double x = std::clamp(double(u.direction.x), kMargin, 1 - kMargin);
  const double y = std::clamp(double(u.direction.y), kMargin, 1 - kMargin);
  const auto draw = [&](double lobe, double dx, double dy) -> std::optional<BsdfSample> {
    const std::optional<BsdfSample> s =
        sample(material, wo, {Float(lobe), {Float(x + dx), Float(y + dy)}}, at);
    return s && !s->is_delta ? s : std::nullopt;
  };
  const auto lobe = double(u.lobe);
  const std::optional<BsdfSample> here = draw(lobe, 0, 0);
  std::array<Vec3, 4> along_x{}, along_y{};
  constexpr std::array<double, 4> kPlaces{-2, -1, 1, 2};
  for (std::size_t i = 0; i < kPlaces.size(); ++i) {
    const std::optional<BsdfSample> sx = draw(lobe, kPlaces[i] * kStep, 0);
    const std::optional<BsdfSample> sy = draw(lobe, 0, kPlaces[i] * kStep);
    if (!here || !sx || !sy) return std::nullopt;
    // Near the critical angle a neighbour may be refracted where this one is reflected: no map to differentiate.
    if (sx->wi.z * here->wi.z < 0 || sy->wi.z * here->wi.z < 0) return std::nullopt;
    along_x[i] = sx->wi, along_y[i] = sy->wi;
  }
  const double solid_angle = cross_length(derivative(along_x[0], along_x[1], along_x[2], along_x[3]),
                                          derivative(along_y[0], along_y[1], along_y[2], along_y[3]));
  const auto direction_at = [&](double number) -> std::optional<Vec3> {
    const std::optional<BsdfSample> s = draw(number, 0, 0);
    return s ? std::optional(s->wi) : std::nullopt;
  };
  return LobeDensity{.density_of_map = 1 / std::max(solid_angle, 1e-300),
                     .share_of_numbers = share_of_same(direction_at, here->wi),
                     .pdf = double(here->pdf)};
}

}  // namespace spectrace::test
