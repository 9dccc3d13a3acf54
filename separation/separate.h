// SPDX-License-Identifier: Apache-2.0
// Separation of a measured BRDF into a Lambert and a specular lobe: "Separation of Reflection Components for
// Measured Spectral BRDFs"; equation numbers are the paper's, deviations are argued in docs/separation.md.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "materials/measured_brdf.h"
#include "materials/separated_tables.h"

namespace spectrace {

/// The weight w_j of eqs. 9 and 17.
enum class CosineWeight {
  kProduct,  ///< max(cosθi · cosθo, ε): what the paper's text says
  kPrinted,  ///< max(cosθi, cosθo, ε): eq. 10 as printed
};

/// What eqs. 19 and 20 compare.
enum class SpectralResidual {
  kWhole,  ///< ρ with s_d ρ_d + s ρ_s, as eq. 18 does: each model then minimises one objective over a larger
           ///< family
  kPrinted,  ///< ρ - s_d ρ_d, clamped at 0, with s ρ_s
};

struct SeparationOptions {
  HalfDifferenceGrid grid;  ///< paper: 90 x 90 x 180; spacing of theta_h: separation.md
  CosineWeight weight = CosineWeight::kProduct;
  SpectralResidual residual = SpectralResidual::kWhole;
  double epsilon = 1e-3;                         ///< of eqs. 9 and 10; > 0; paper: 1e-3
  double eta_diffuse = 0.9, eta_specular = 0.8;  ///< eq. 16; > 0; paper: 0.9, 0.8
  int starts = 4;                                ///< of step 1's solver, at least 1
  double diffraction_prior = 5;  ///< samples' worth of s_F drawn into s_D where rho_s vanishes; >= 0
  int threads = 0;               ///< 0 = all cores

  /// Empty where valid, else which field breaks which rule.
  [[nodiscard]] std::string problem() const;
};

/// The parameters of eqs. 11-15.
struct AnalyticFit {
  double albedo_d = 0;  ///< alpha_d, [0, 1]
  double rho_0 = 0;     ///< >= 0
  double f_0 = 0;       ///< [0, 1]
  double alpha = 0;     ///< GGX a, [1e-3, 1]
};

struct SeparationReport {
  bool usable = true;   ///< false: no cell was measured, or step 1 did not converge from any start
  std::string verdict;  ///< one line
  AnalyticFit fit;
  double step1_initial_cost = 0, step1_final_cost = 0;  ///< ½ Σ (log residual)²
  double step1_gradient_max = 0;  ///< infinity norm of the projected gradient at the solution
  int step1_iterations = 0;
  double step2_cost = 0;  ///< eq. 16
  /// Share of the energy Σ w ρ missing where mean < alpha_d/pi: what an exact Lambert lobe costs.
  double lambert_cost = 0;
  double specular_share = 0;  ///< of that energy
  /// [axis] root mean square of ln(ρ w + ε) less ln(model w + ε) over the measured cells (eqs. 18-20).
  std::vector<double> rms_sun, rms_fresnel, rms_diffraction;
  double seconds_table = 0, seconds_step1 = 0, seconds_step2 = 0, seconds_step3 = 0;
  std::size_t cells = 0, below_horizon = 0, measured = 0, extrapolated = 0, unmeasured = 0;  ///< of the grid
  std::size_t negative_values = 0;  ///< of the file, clamped to 0
  SeparationOptions options;        ///< as used

  [[nodiscard]] std::string brief() const;  ///< one line
  [[nodiscard]] std::string full() const;   ///< a table for people
  /// Without timings the same input gives the same text, on any number of threads: what a `.sep` file stores.
  [[nodiscard]] std::string json(bool with_timings = true) const;
};

struct SeparationResult {
  SeparatedTables tables;
  SeparationReport report;
};

/// Never throws for what the data hold: `report.usable` tells. Invalid options are a programmer's error
/// (check problem() first).
SeparationResult separate(const MeasuredBrdf& measured, const SeparationOptions& options, Progress& progress);

}  // namespace spectrace
