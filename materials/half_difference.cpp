// SPDX-License-Identifier: Apache-2.0
#include "materials/half_difference.h"

#include <algorithm>
#include <cmath>

#include "core/math/angles.h"
#include "core/math/math.h"

namespace spectrace {

namespace {

/// In double: theta_d near 90 degrees is a difference of nearly opposite directions.
struct Triple {
  double x, y, z;
};
Triple sum(Vec3 a, Vec3 b) { return {double(a.x) + b.x, double(a.y) + b.y, double(a.z) + b.z}; }
Triple difference(Vec3 a, Vec3 b) { return {double(a.x) - b.x, double(a.y) - b.y, double(a.z) - b.z}; }
double norm(const Triple& a) { return std::sqrt(a.x * a.x + a.y * a.y + a.z * a.z); }
/// Of the first quadrant, mirrored to the second where `x` is negative; without a branch, whose outcome would
/// be as random as the directions.
double into_quadrant(double angle, double x) { return kPi64 / 2 - std::copysign(kPi64 / 2 - angle, x); }
Vec3 to_vec3(const Triple& a) { return {Float(a.x), Float(a.y), Float(a.z)}; }

}  // namespace

double theta_of(Vec3 w) {
  const double xy = std::sqrt(double(w.x) * w.x + double(w.y) * w.y);
  return first_quadrant_angles(DoublePair{xy, 0}, DoublePair{std::max(double(w.z), 0.0), 0})[0];
}

PairGeometry geometry_of(Vec3 wo, Vec3 wi) {
  const Triple h = sum(wo, wi), d = difference(wi, wo);
  const double h_norm = norm(h), h_xy2 = h.x * h.x + h.y * h.y, h_xy = std::sqrt(h_xy2);
  // d in the frame around h, whose first axis points down the meridian and whose second along the parallel:
  // both times |h| |h_xy|, which spares the divisions.
  const double along_t = (d.x * h.x + d.y * h.y) * h.z - d.z * h_xy2;
  const double along_b = (d.y * h.x - d.x * h.y) * h_norm;
  const double cos_h = wo.x * h.x + wo.y * h.y,
               sin_h = wo.x * h.y - wo.y * h.x;  // of phi_h, times |o_xy| |h_xy|
  // 1 - h.z / |h| would lose all digits near the pole.
  const double z_h = h_norm > 0 ? h_xy2 / (h_norm * (h_norm + h.z)) : 0;
  // The angle between the two is 2 theta_d; |wi - wo| = 2 sin theta_d, |wi + wo| = 2 cos theta_d.
  const DoublePair theta_h_d =
      first_quadrant_angles(DoublePair{h_xy, norm(d)}, DoublePair{std::max(h.z, 0.0), h_norm});
  const DoublePair phi_d_h = first_quadrant_angles(DoublePair{std::abs(along_b), std::abs(sin_h)},
                                                   DoublePair{std::abs(along_t), std::abs(cos_h)});
  HalfDifference angles{.theta_h = theta_h_d[0], .theta_d = theta_h_d[1]};
  // Azimuths that differ by π are the same pair with wi and wo swapped; what rounds to π is 0 of the other
  // pair.
  const double phi_d = into_quadrant(phi_d_h[0], along_t * along_b);
  angles.phi_d = phi_d < kPi64 ? phi_d : 0;
  angles.is_swapped = angles.phi_d == 0 ? along_t < 0 : along_b < 0;
  return {.angles = angles,
          .cos_d = h_norm / 2,
          .z_h = z_h,
          .phi_h = into_quadrant(phi_d_h[1], cos_h),
          .theta_o = theta_of(wo)};
}

DirectionPair from_half_difference(const HalfDifference& angles) {
  const double cos_h = std::cos(angles.theta_h), sin_h = std::sin(angles.theta_h);
  const double cos_d = std::cos(angles.theta_d), sin_d = std::sin(angles.theta_d);
  const double x = sin_d * std::cos(angles.phi_d), y = sin_d * std::sin(angles.phi_d);
  // Around h, wi is (x, y, cos_d) and its mirror image wo is (-x, -y, cos_d); then h is tilted by theta_h.
  const auto tilted = [&](double tx, double ty) {
    return to_vec3({cos_h * tx + sin_h * cos_d, ty, cos_h * cos_d - sin_h * tx});
  };
  return {.wo = tilted(-x, -y), .wi = tilted(x, y)};
}

}  // namespace spectrace
