// SPDX-License-Identifier: Apache-2.0
// The one mapping between microfacet normals and the unit square of the EPFL tables: Dupuy & Jakob 2018,
// sec. 5.2. Used by evaluation, sampling and acquisition alike.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/math/math.h"
#include "core/math/vec.h"

namespace spectrace {

/// x of the square from the elevation [rad] in [0, π/2], and back: most nodes lie near the normal, where
/// specular lobes need them.
inline Float polar_coordinate(Float theta_rad) {
  return std::min(std::sqrt(theta_rad * (2 / kPi)), Float(1));
}
inline Float polar_angle(Float x) { return sqr(x) * (kPi / 2); }
/// y of the square from any azimuth [rad], in [0, 1), and back into [-π, π].
inline Float azimuth_coordinate(Float phi_rad) {
  const Float y = (phi_rad + kPi) / (2 * kPi);
  return y - std::floor(y);
}
inline Float azimuth_angle(Float y) { return (2 * y - 1) * kPi; }

/// `n.z` >= 0; at θ = 0 the azimuth is 0. Exact to rounding at small θ, since θ comes from atan2.
inline Vec2 normal_to_square(Vec3 n) {
  return {polar_coordinate(std::atan2(std::hypot(n.x, n.y), n.z)), azimuth_coordinate(std::atan2(n.y, n.x))};
}

/// The inverse, for `s` in [0, 1]².
inline Vec3 square_to_normal(Vec2 s) {
  const Float theta = polar_angle(s.x), phi = azimuth_angle(s.y);
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

/// Solid angle per unit square area: dθ/dx · dφ/dy · sinθ = 2π² x sinθ.
inline Float normal_square_jacobian(Vec2 s) { return 2 * sqr(kPi) * s.x * std::sin(sqr(s.x) * (kPi / 2)); }

}  // namespace spectrace
