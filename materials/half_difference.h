// SPDX-License-Identifier: Apache-2.0
// Rusinkiewicz' half-difference angles of an isotropic BRDF: the coordinates of the paper's table X.
#pragma once

#include "core/math/vec.h"

namespace spectrace {

/// [rad]. theta_h, theta_d in [0, π/2]; phi_d in [0, π), reduced by reciprocity (swapping wi and wo adds π).
struct HalfDifference {
  double theta_h = 0, theta_d = 0, phi_d = 0;
  bool is_swapped = false;  ///< π was taken off phi_d: these angles are of the pair with wi and wo exchanged
};

struct DirectionPair {
  Vec3 wo, wi;
};

/// Unit directions, z up. theta_h = 0 or theta_d = 0 leave phi_d undefined: 0 then. wi = -wo gives
/// theta_d = π/2 and theta_h = 0. Note cosθo + cosθi = 2 cosθh cosθd.
HalfDifference to_half_difference(Vec3 wo, Vec3 wi);
/// The pair with the half vector in the xz-plane; either may lie below the horizon.
DirectionPair from_half_difference(const HalfDifference& angles);

}  // namespace spectrace
