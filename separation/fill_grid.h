// SPDX-License-Identifier: Apache-2.0
// What a table on the half-difference grid holds where no direction pair exists.
#pragma once

#include <vector>

#include "materials/half_difference_grid.h"

namespace spectrace {

/// `table` is [theta_h][theta_d][phi_d], negative where it has no value. Such nodes take those of their
/// nearest neighbours in phi_d, else in theta_h; the poles become one value each, so that lookups are
/// continuous.
void fill_unmeasured(const HalfDifferenceGrid& grid, std::vector<float>& table);

}  // namespace spectrace
