// SPDX-License-Identifier: Apache-2.0
// The density of a sampler's map from random numbers to directions, by finite differences: nothing that the
// sampler itself says of densities goes into it.
#pragma once

#include <optional>

#include "materials/material.h"

namespace spectrace::test {

struct LobeDensity {
  double density_of_map = 0;    ///< [1/sr]: squares of random numbers over the solid angle they go to
  double share_of_numbers = 0;  ///< in [0, 1]: of all u.lobe, those that give the same map
  double pdf = 0;               ///< [1/sr]: what the sample says
};

/// At u, moved away from the edges of the unit square. share_of_numbers · density_of_map is the part of the
/// density that one lobe has: at most `pdf`, and equal to it where there is one lobe. Nothing where the
/// sample or a neighbour is lost, or comes from a delta lobe.
std::optional<LobeDensity> density_by_differences(const Material& material, Vec3 wo, BsdfRandom u,
                                                  const ShadingPoint& at);

}  // namespace spectrace::test
