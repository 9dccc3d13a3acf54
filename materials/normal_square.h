// SPDX-License-Identifier: Apache-2.0
// The one mapping between microfacet normals and the unit square of the EPFL tables: Dupuy & Jakob 2018,
// sec. 5.2. Used by evaluation, sampling and acquisition alike.
#pragma once

#include <cmath>

#include "core/math/math.h"
#include "core/math/vec.h"

namespace spectrace {

/// x = sqrt(2 θ/π), which spends most nodes near the normal; y = (φ + π) / 2π. `n.z` >= 0; at θ = 0 the
/// azimuth is 0. Exact to rounding at small θ, since θ comes from atan2.
inline Vec2 normal_to_square(Vec3 n) {
  const Float theta = std::atan2(std::hypot(n.x, n.y), n.z);
  return {std::sqrt(std::min(theta * (2 / kPi), Float(1))), (std::atan2(n.y, n.x) + kPi) * (kInvPi / 2)};
}

/// The inverse, for `s` in [0, 1]².
inline Vec3 square_to_normal(Vec2 s) {
  const Float theta = sqr(s.x) * (kPi / 2), phi = (2 * s.y - 1) * kPi;
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

/// Solid angle per unit square area: dθ/dx · dφ/dy · sinθ = 2π² x sinθ.
inline Float normal_square_jacobian(Vec2 s) { return 2 * sqr(kPi) * s.x * std::sin(sqr(s.x) * (kPi / 2)); }

}  // namespace spectrace
