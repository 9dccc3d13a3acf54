// SPDX-License-Identifier: Apache-2.0
#include "materials/half_difference_grid.h"

#include <algorithm>
#include <cmath>

#include "core/math/math.h"

namespace spectrace {
namespace {

constexpr double kHalfPi = kPi64 / 2;
constexpr double kPerHalfPi = 1 / kHalfPi, kPerPi = 1 / kPi64;  // products: divisions take thrice as long

/// A node and its upper neighbour.
struct Bracket {
  std::uint32_t lower = 0, upper = 0;
  float fraction = 0;
};

Bracket bracket(double coordinate, int nodes) {
  const int lower = std::min(static_cast<int>(coordinate), nodes - 1);
  return {static_cast<std::uint32_t>(lower), static_cast<std::uint32_t>(std::min(lower + 1, nodes - 1)),
          static_cast<float>(coordinate - lower)};
}

/// Of nodes at (i/n)² 90 degrees. Between them linear in the angle itself: linear in its root would have a
/// cusp at theta_h = 0.
Bracket bracket_of_squares(double coordinate, int nodes) {
  Bracket b = bracket(coordinate, nodes);
  const double i = b.lower;
  b.fraction = static_cast<float>(std::max((coordinate * coordinate - i * i) / (2 * i + 1), 0.0));
  return b;
}

}  // namespace

double HalfDifferenceGrid::theta_h(double i) const {
  const double x = i / n_theta_h;
  return (quadratic_theta_h ? x * x : x) * kHalfPi;
}
double HalfDifferenceGrid::theta_d(double j) const { return j / n_theta_d * kHalfPi; }
double HalfDifferenceGrid::phi_d(double k) const { return k / n_phi_d * kPi64; }

double HalfDifferenceGrid::coordinate_h(double theta_h_rad) const {
  const double x = std::max(theta_h_rad, 0.0) * kPerHalfPi;
  return std::min((quadratic_theta_h ? std::sqrt(x) : x) * n_theta_h, n_theta_h - 1.0);
}
double HalfDifferenceGrid::coordinate_d(double theta_d_rad) const {
  return std::clamp(theta_d_rad * kPerHalfPi * n_theta_d, 0.0, n_theta_d - 1.0);
}
double HalfDifferenceGrid::coordinate_p(double phi_d_rad) const {
  double turns = phi_d_rad * kPerPi;
  turns -= static_cast<double>(static_cast<std::int64_t>(turns));  // std::floor would be a call
  if (turns < 0) turns += 1;
  const double k = turns * n_phi_d;
  return k < n_phi_d ? k : 0.0;  // rounding may reach n_phi_d, which is node 0
}

GridPoint HalfDifferenceGrid::locate(const HalfDifference& angles) const {
  const Bracket h = quadratic_theta_h ? bracket_of_squares(coordinate_h(angles.theta_h), n_theta_h)
                                      : bracket(coordinate_h(angles.theta_h), n_theta_h);
  const Bracket d = bracket(coordinate_d(angles.theta_d), n_theta_d);
  const double k = coordinate_p(angles.phi_d);
  const auto p0 = static_cast<std::uint32_t>(k);
  const std::uint32_t p1 = p0 + 1 < static_cast<std::uint32_t>(n_phi_d) ? p0 + 1 : 0;
  const auto fraction_p = static_cast<float>(k - p0);

  // Each index from registers: reading back a vector of just written scalars would wait for the store.
  const std::uint32_t row0 = h.lower * n_theta_d, row1 = h.upper * n_theta_d, n = n_phi_d;
  const std::uint32_t a0 = row0 + d.lower, a1 = row0 + d.upper, a2 = row1 + d.lower, a3 = row1 + d.upper;
  const float w0 = (1 - h.fraction) * (1 - d.fraction), w1 = (1 - h.fraction) * d.fraction,
              w2 = h.fraction * (1 - d.fraction), w3 = h.fraction * d.fraction, f = fraction_p, g = 1 - f;
  GridPoint point;
  const float sign = angles.is_swapped ? -1 : 1;
  point.odd_sign = {sign, p1 > p0 ? sign : -sign};
  point.cell = {a0 * n + p0, a0 * n + p1, a1 * n + p0, a1 * n + p1,
                a2 * n + p0, a2 * n + p1, a3 * n + p0, a3 * n + p1};
  point.cell_weight = {w0 * g, w0 * f, w1 * g, w1 * f, w2 * g, w2 * f, w3 * g, w3 * f};
  point.angular = {a0, a1, a2, a3};
  point.angular_weight = {w0, w1, w2, w3};
  point.theta_d = {d.lower, d.upper};
  point.theta_d_weight = {1 - d.fraction, d.fraction};
  return point;
}

}  // namespace spectrace
