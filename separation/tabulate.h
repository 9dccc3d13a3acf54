// SPDX-License-Identifier: Apache-2.0
// A measurement interpolated onto the paper's table X (sec. 4.1), at every wavelength.
#pragma once

#include "materials/tabulated_brdf.h"
#include "separation/separate.h"

namespace spectrace {

/// Both orders of each pair averaged; nodes without a pair filled as rho_s is. size() · axis floats: 1.1 GB
/// for the paper's grid at 195 wavelengths. Of `options` the grid and the threads count.
HalfDifferenceTable tabulate(const MeasuredBrdf& measured, const SeparationOptions& options);

/// The same with what is odd in the exchange of the directions: twice the memory, and no longer reciprocal.
HalfDifferenceTable tabulate_oriented(const MeasuredBrdf& measured, const SeparationOptions& options);

/// The plain table for comparison (materials/plain_table_brdf.h): f in one order of the pair, NaN where the
/// measurement says nothing.
HalfDifferenceTable tabulate_plain(const MeasuredBrdf& measured, const SeparationOptions& options);

}  // namespace spectrace
