// SPDX-License-Identifier: Apache-2.0
// The analytic model of sec. 5.3: eqs. 7-15 fitted at each wavelength apart.
#pragma once

#include <vector>

#include "separation/analytic_fit.h"
#include "separation/log_block.h"

namespace spectrace {

struct AnalyticSpectra {
  std::vector<float> parameters;  ///< [4][axis]: albedo_d, rho_0, f_0, alpha
  std::vector<double> rms;        ///< [axis] root mean square of eq. 9 over the cells it was fitted to
};

// Four parameters need no million cells: one in 29 (a prime, which divides no dimension of the paper's grid)
// moves them by less than 1 % (docs/separation.md).
inline constexpr std::size_t kAnalyticStride = 29;

/// Each solved on every kAnalyticStride-th cell, from the fit at the wavelength before, or from the
/// achromatic one where a strip begins.
AnalyticSpectra fit_analytic_spectra(const MeasuredBrdf& measured, const CellTable& table,
                                     const AnalyticFit& achromatic, const SeparationOptions& options);

}  // namespace spectrace
