// SPDX-License-Identifier: Apache-2.0
// Step 2 (sec. 4.3): the achromatic BRDF split into its diffuse and specular part, eqs. 16-17.
#pragma once

#include <vector>

#include "separation/cell_table.h"
#include "separation/separate.h"

namespace spectrace {

/// The x in [0, mean] that minimises eta_d |x - diffuse| + eta_s |mean - x - specular|: one cell of eq. 16,
/// whose weight w multiplies both terms and drops out. A weighted median, hence exact; of equal minima the
/// one nearest `diffuse`. All arguments >= 0.
double split_cell(double mean, double diffuse, double specular, double eta_diffuse, double eta_specular);

/// Of the light reflected under uniform light, averaged over the measured directions: the share that a
/// Lambert lobe of this albedo has too much, where the measured mean is below albedo/π. 0 for a black
/// measurement.
double lambert_excess(const CellTable& table, double albedo);

/// The most that a Lambert lobe of the true colour had too much over the acquired materials of
/// known_truth_test: beyond it the measurement refutes the lobe's level.
inline constexpr double kSupportedExcess = 0.003;
/// Whether it is to be lowered then: not in the paper's printed form, nor where the lobe's shape gives way.
[[nodiscard]] inline bool bounds_diffuse_lobe(const SeparationOptions& options) {
  return options.colour == DiffuseColour::kDark && options.diffuse == DiffuseForm::kLambert;
}

struct SplitResult {
  /// [theta_h][theta_d][phi_d] as SeparatedTables::rho_s: ρ_s (cosθi + cosθo), >= 0, below the horizon
  /// filled.
  std::vector<float> rho_s;
  std::vector<float> diffuse_shape;  ///< as SeparatedTables::diffuse_shape; empty where exactly Lambertian
  double albedo_d = 0;               ///< of the Lambert lobe, alpha_d or exactly 0
  double cost = 0;                   ///< eq. 16 at the paper's optimum
  double lambert_cost = 0;           ///< SeparationReport::lambert_cost
  double specular_share = 0;         ///< SeparationReport::specular_share
};
/// `matte`: there is no specular lobe (AnalyticSolution::matte).
SplitResult split_lobes(const CellTable& table, const AnalyticFit& fit, bool matte,
                        const SeparationOptions& options);

}  // namespace spectrace
