// SPDX-License-Identifier: Apache-2.0
#include "materials/half_difference_grid.h"

#include <algorithm>
#include <cmath>

#include "core/math/math.h"

namespace spectrace {
namespace {

constexpr double kHalfPi = kPi64 / 2;

/// A node and its upper neighbour.
struct Bracket {
  std::uint32_t lower = 0, upper = 0;
  float fraction = 0;
};

Bracket bracket(double coordinate, int nodes) {
  const int lower = std::clamp(static_cast<int>(coordinate), 0, nodes - 1);
  return {static_cast<std::uint32_t>(lower), static_cast<std::uint32_t>(std::min(lower + 1, nodes - 1)),
          static_cast<float>(coordinate - lower)};
}

}  // namespace

double HalfDifferenceGrid::theta_h(double i) const {
  const double x = i / n_theta_h;
  return (quadratic_theta_h ? x * x : x) * kHalfPi;
}
double HalfDifferenceGrid::theta_d(double j) const { return j / n_theta_d * kHalfPi; }
double HalfDifferenceGrid::phi_d(double k) const { return k / n_phi_d * kPi64; }

double HalfDifferenceGrid::coordinate_h(double theta_h_rad) const {
  const double x = std::max(theta_h_rad, 0.0) / kHalfPi;
  return std::min((quadratic_theta_h ? std::sqrt(x) : x) * n_theta_h, n_theta_h - 1.0);
}
double HalfDifferenceGrid::coordinate_d(double theta_d_rad) const {
  return std::clamp(theta_d_rad / kHalfPi * n_theta_d, 0.0, n_theta_d - 1.0);
}
double HalfDifferenceGrid::coordinate_p(double phi_d_rad) const {
  const double turns = phi_d_rad / kPi64;
  const double k = (turns - std::floor(turns)) * n_phi_d;
  return k < n_phi_d ? k : 0.0;  // rounding may reach n_phi_d, which is node 0
}

GridPoint HalfDifferenceGrid::locate(const HalfDifference& angles) const {
  // Between nodes linear in the angle itself: linear in its root would have a cusp at theta_h = 0.
  Bracket h = bracket(coordinate_h(angles.theta_h), n_theta_h);
  if (h.upper > h.lower) {
    const double first = theta_h(h.lower);
    h.fraction =
        static_cast<float>(std::clamp((angles.theta_h - first) / (theta_h(h.upper) - first), 0.0, 1.0));
  }
  const Bracket d = bracket(coordinate_d(angles.theta_d), n_theta_d);
  const double k = coordinate_p(angles.phi_d);
  const auto p0 = static_cast<std::uint32_t>(k);
  const std::uint32_t p1 = p0 + 1 < static_cast<std::uint32_t>(n_phi_d) ? p0 + 1 : 0;
  const auto fraction_p = static_cast<float>(k - p0);

  GridPoint point;
  const float sign = angles.is_swapped ? -1 : 1;
  point.odd_sign = {sign, p1 > p0 ? sign : -sign};
  const std::array<std::uint32_t, 4> angular{h.lower * n_theta_d + d.lower, h.lower * n_theta_d + d.upper,
                                             h.upper * n_theta_d + d.lower, h.upper * n_theta_d + d.upper};
  point.angular = angular;
  point.angular_weight = {(1 - h.fraction) * (1 - d.fraction), (1 - h.fraction) * d.fraction,
                          h.fraction * (1 - d.fraction), h.fraction * d.fraction};
  for (int i = 0; i < 4; ++i) {
    point.cell[2 * i] = angular[i] * n_phi_d + p0;
    point.cell[2 * i + 1] = angular[i] * n_phi_d + p1;
    point.cell_weight[2 * i] = point.angular_weight[i] * (1 - fraction_p);
    point.cell_weight[2 * i + 1] = point.angular_weight[i] * fraction_p;
  }
  point.theta_d = {d.lower, d.upper};
  point.theta_d_weight = {1 - d.fraction, d.fraction};
  return point;
}

}  // namespace spectrace
