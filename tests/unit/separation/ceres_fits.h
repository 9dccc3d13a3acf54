// SPDX-License-Identifier: Apache-2.0
// The fits of the separation as the paper poses them, given to Ceres whole: one residual a cell, in double.
// What the program's own solvers are held against (ADR 0009).
#pragma once

#include <limits>
#include <vector>

#include "separation/cell_table.h"
#include "separation/diffuse_colour.h"
#include "separation/separate.h"

namespace spectrace::test {

struct CeresFit {
  std::vector<double> x;
  double cost = 0;          ///< ½ Σ r²
  double gradient_max = 0;  ///< of the cost, projected on the bounds, infinity norm
  double seconds = 0;
};

/// Eqs. 7-15 as printed over all fitted cells; x = alpha_d, rho_0, F_0, ln a. Derivatives by automatic
/// differentiation.
CeresFit ceres_eq_7(const CellTable& table, double epsilon, const AnalyticFit& start);

/// ½ Σ r² and its gradient there.
CeresFit cost_of_eq_7(const CellTable& table, double epsilon, const AnalyticFit& at);

/// Eq. 7 with a free factor for each theta_d, over every 7th cell of each (theta_h, theta_d) well above the
/// horizon, as fit_free_fresnel() has it; x = alpha_d, ln a, factors.
CeresFit ceres_free_fresnel(const CellTable& table, double epsilon, const FreeFresnelFit& start);
CeresFit cost_of_free_fresnel(const CellTable& table, double epsilon, const FreeFresnelFit& at);

/// One cell of eqs. 18-20 at one wavelength, times w.
struct ColourSample {
  double data = 0, diffuse = 0, specular = 0;
};
/// r = ln(data + ε) - ln(s_d diffuse + s specular + ε); x = s_d, s of eq. 18.
CeresFit ceres_two_lobes(const std::vector<ColourSample>& samples, double epsilon, double s_d, double s);
/// x = s of eqs. 19 and 20, s_d given, s in [0, highest].
CeresFit ceres_colour(const std::vector<ColourSample>& samples, double epsilon, double s_d, double s,
                      double highest);
double cost_of_colours(const std::vector<ColourSample>& samples, double epsilon, double s_d, double s);

}  // namespace spectrace::test
