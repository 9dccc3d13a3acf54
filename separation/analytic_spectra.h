// SPDX-License-Identifier: Apache-2.0
// The analytic model of sec. 5.3: eqs. 7-15 fitted at each wavelength apart.
#pragma once

#include <vector>

#include "separation/analytic_fit.h"

namespace spectrace {

/// [4][axis]: albedo_d, rho_0, f_0, alpha, each solved from the achromatic fit on a fixed part of the cells.
std::vector<float> fit_analytic_spectra(const MeasuredBrdf& measured, const CellTable& table,
                                        const AnalyticFit& achromatic, const SeparationOptions& options);

}  // namespace spectrace
