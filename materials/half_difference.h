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

/// Of a pair of directions: what tables over the half-difference angles ask, and samplers of half vectors.
struct PairGeometry {
  HalfDifference angles;
  double cos_d = 0;    ///< cosine of theta_d
  double z_h = 0;      ///< 1 - cosine of theta_h, to all its digits
  double phi_h = 0;    ///< [rad] in [0, π]: azimuth between the half vector and wo, 0 or π where undefined
  double theta_o = 0;  ///< [rad] theta_of(wo)
};

struct DirectionPair {
  Vec3 wo, wi;
};

/// Unit directions, z up, their sum not below the horizon. theta_h = 0 or theta_d = 0 leave phi_d undefined:
/// 0 then. wi = -wo gives theta_d = π/2 and theta_h = 0. Note cosθo + cosθi = 2 cosθh cosθd.
PairGeometry geometry_of(Vec3 wo, Vec3 wi);
/// [rad] from the z axis; π/2 below the horizon.
double theta_of(Vec3 w);
inline HalfDifference to_half_difference(Vec3 wo, Vec3 wi) { return geometry_of(wo, wi).angles; }
/// The pair with the half vector in the xz-plane; either may lie below the horizon.
DirectionPair from_half_difference(const HalfDifference& angles);

}  // namespace spectrace
