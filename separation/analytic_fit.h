// SPDX-License-Identifier: Apache-2.0
// Step 1 (sec. 4.2): Lambert + GGX fitted to the achromatic BRDF, eqs. 7-15.
#pragma once

#include <array>

#include "separation/cell_table.h"
#include "separation/lobe_equations.h"
#include "separation/separate.h"

namespace spectrace {

/// The parameters as the paper has them: alpha_d, rho_0, F_0, ln a.
using FitVector = std::array<double, kFitParameters>;
FitVector to_vector(const AnalyticFit& fit);
AnalyticFit from_vector(const FitVector& x);

/// ½ Σ r² over all of `cells` with r of eqs. 7-10, and what Gauss-Newton needs of it.
struct FitEquations {
  double cost = 0;
  FitVector gradient{};                             ///< Jᵀr
  std::array<FitVector, kFitParameters> hessian{};  ///< JᵀJ
};
FitEquations fit_equations(const LobeCells& cells, double epsilon, const FitVector& x);

struct AnalyticSolution {
  AnalyticFit fit;
  /// Lambert alone explains the measurement as well as such a measurement can tell: no specular lobe, rho_0 =
  /// 0.
  bool matte = false;
  bool converged = false;
  double initial_cost = 0, final_cost = 0;
  double gradient_max = 0;  ///< of the cost per cell, projected on the bounds, infinity norm
  int iterations = 0;       ///< on all cells
};
/// Solved by Ceres (trust region with bounds): `options.starts` starts are followed on a part of the cells,
/// and the one of lowest cost is solved on all. `initial_cost` is the cost on all cells where that last solve
/// began.
AnalyticSolution fit_analytic(const CellTable& table, const SeparationOptions& options);

struct RefinedFit {
  AnalyticFit fit;
  double cost = 0;
};
/// The solution on all of `cells` that lies in the valley of `start`; on this thread.
RefinedFit refine_analytic(const LobeCells& cells, const SeparationOptions& options,
                           const AnalyticFit& start);

}  // namespace spectrace
