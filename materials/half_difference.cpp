// SPDX-License-Identifier: Apache-2.0
#include "materials/half_difference.h"

#include <cmath>

#include "core/math/math.h"

namespace spectrace {

namespace {

/// In double: theta_d near 90 degrees is a difference of nearly opposite directions.
struct Triple {
  double x, y, z;
};
Triple sum(Vec3 a, Vec3 b) { return {double(a.x) + b.x, double(a.y) + b.y, double(a.z) + b.z}; }
Triple difference(Vec3 a, Vec3 b) { return {double(a.x) - b.x, double(a.y) - b.y, double(a.z) - b.z}; }
double norm(const Triple& a) { return std::hypot(a.x, a.y, a.z); }
Vec3 to_vec3(const Triple& a) { return {Float(a.x), Float(a.y), Float(a.z)}; }

/// Azimuths that differ by π are the same pair with wi and wo swapped. `phi` in [-π, π].
void reduce_by_reciprocity(double phi, HalfDifference& out) {
  out.is_swapped = phi < 0 || phi >= kPi64;
  out.phi_d = phi < 0 ? phi + kPi64 : phi;
  if (out.phi_d < kPi64) return;
  // π itself is 0 of the swapped pair; what rounding lifts to π is 0 of the pair as it is.
  out.phi_d = 0;
  out.is_swapped = phi >= kPi64;
}

}  // namespace

HalfDifference to_half_difference(Vec3 wo, Vec3 wi) {
  const Triple h = sum(wo, wi), d = difference(wi, wo);
  const double h_norm = norm(h), d_norm = norm(d);
  // The angle between the two is 2 theta_d; |wi - wo| = 2 sin theta_d, |wi + wo| = 2 cos theta_d.
  HalfDifference out{.theta_h = 0, .theta_d = std::atan2(d_norm, h_norm), .phi_d = 0};
  const double h_xy = std::hypot(h.x, h.y);
  if (h_norm == 0) return out;
  out.theta_h = std::atan2(h_xy, h.z);
  if (h_xy == 0 || d_norm == 0) return out;
  // The frame around h: `t` points down the meridian, `b` along the parallel.
  const double cos_phi = h.x / h_xy, sin_phi = h.y / h_xy;
  const double cos_theta = h.z / h_norm, sin_theta = h_xy / h_norm;
  const double along_t = d.x * cos_theta * cos_phi + d.y * cos_theta * sin_phi - d.z * sin_theta;
  const double along_b = -d.x * sin_phi + d.y * cos_phi;
  reduce_by_reciprocity(std::atan2(along_b, along_t), out);
  return out;
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
