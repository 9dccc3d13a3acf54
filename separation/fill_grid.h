// SPDX-License-Identifier: Apache-2.0
// What a table on the half-difference grid holds where no direction pair exists.
#pragma once

#include <limits>
#include <vector>

#include "materials/half_difference_grid.h"

namespace spectrace {

/// Marks a node without a value.
inline constexpr float kNoValue = std::numeric_limits<float>::quiet_NaN();

/// `table` is [theta_h][theta_d][phi_d], kNoValue where there is none. Such nodes take the value of their
/// nearest neighbour in phi_d (the mean of two), else in theta_h, else 0; the poles become one value each, so
/// that lookups are continuous.
void fill_unmeasured(const HalfDifferenceGrid& grid, std::vector<float>& table);
/// The same for what is odd in the exchange of the directions: beyond either end of phi_d it goes on with the
/// other sign, and at the poles, where the exchange changes nothing, it is 0.
void fill_unmeasured_odd(const HalfDifferenceGrid& grid, std::vector<float>& table);

}  // namespace spectrace
