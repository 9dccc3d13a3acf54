// SPDX-License-Identifier: Apache-2.0
// Separation of a measured BRDF into a Lambert and a specular lobe: "Separation of Reflection Components for
// Measured Spectral BRDFs"; equation numbers are the paper's, deviations are argued in docs/separation.md.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "materials/analytic_brdf.h"
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

/// Where the level and the spectrum of the diffuse lobe come from.
enum class DiffuseColour {
  kDark,     ///< from where the specular lobe is weakest (separation/diffuse_colour.h)
  kPrinted,  ///< the level from eq. 7, the spectrum from eq. 18
};

/// The diffuse lobe of the result.
enum class DiffuseForm {
  kLambert,  ///< exactly c_d/π; where the measurement is darker than that, the result is too bright
  kTable,    ///< the ρ_d of eq. 16: c_d/π, and no more than the measurement's mean
};

[[nodiscard]] std::string name_of(CosineWeight weight);        ///< "product", "printed"
[[nodiscard]] std::string name_of(DiffuseColour colour);       ///< "dark", "printed"
[[nodiscard]] std::string name_of(DiffuseForm form);           ///< "lambert", "table"
[[nodiscard]] std::string name_of(SpectralResidual residual);  ///< "whole", "printed"

/// Terms of the residual where it is asked for: RGB files have at most three, and at 195 wavelengths more
/// than these change no picture by 0.1 dB (docs/separation.md).
inline constexpr int kDefaultResidualRank = 4;

/// Cells of the largest grid: CellTable counts their nodes, two footprints a cell, in 32 bits.
inline constexpr std::size_t kMaxCells =
    std::numeric_limits<std::uint32_t>::max() / (2 * std::size_t(MeasuredBrdf::Footprint::kMaxNodes));

struct SeparationOptions {
  HalfDifferenceGrid grid;  ///< at most kMaxCells; paper: 90 x 90 x 180; spacing of theta_h: separation.md
  CosineWeight weight = CosineWeight::kProduct;
  DiffuseColour colour = DiffuseColour::kDark;
  DiffuseForm diffuse = DiffuseForm::kLambert;
  SpectralResidual residual = SpectralResidual::kWhole;
  double epsilon = 1e-3;  ///< of eqs. 9 and 10; > 0; paper: 1e-3
  int starts = 4;         ///< of step 1's solver, at least 1
  /// Draws s_D to s_F where the data say nothing: counts so many samples where rho_s vanishes, and fades as
  /// soon as the data of a cell are worth more; >= 0. Default: enough to decide what is undetermined, too
  /// little to move the rest (docs/separation.md).
  double diffraction_prior = 0.01;
  /// Terms of the model kResidual, at most kMaxResidualRank; 0: not fitted, which saves its time.
  int residual_rank = 0;
  /// The residual leaves out what the measurement has in one order of a pair of directions and not in the
  /// other; for methods that need reciprocal materials.
  bool reciprocal = false;
  bool analytic = false;  ///< also fit the model of sec. 5.3, Lambert + GGX at each wavelength
  int threads = 0;        ///< 0 = all cores

  /// Empty where valid, else which field breaks which rule.
  [[nodiscard]] std::string problem() const;
};

/// The parameters of eqs. 11-15, of the achromatic BRDF.
using AnalyticFit = AnalyticParameters;

struct SeparationReport {
  bool usable = true;   ///< false: no cell was measured, or step 1 did not converge from any start
  std::string verdict;  ///< one line
  AnalyticFit fit;
  bool matte = false;  ///< Lambert alone explains the measurement: there is no specular lobe
  double step1_initial_cost = 0, step1_final_cost = 0;  ///< ½ Σ (log residual)²
  double step1_gradient_max = 0;  ///< infinity norm of the projected gradient at the solution
  int step1_iterations = 0;
  bool dark_colour = false;  ///< c_d was read where the specular lobe is weakest
  double albedo_scale = 1;   ///< what alpha_d was lowered by, to what the measurement supports
  double albedo_d = 0;       ///< mean of c_d over the axis: what steps 2 and 3 took for alpha_d
  double step2_cost = 0;     ///< eq. 16
  /// Of the light reflected under uniform light, averaged over the measured directions: how much an exact
  /// Lambert lobe has too much (where mean < alpha_d/pi), and how much is specular.
  double lambert_cost = 0, specular_share = 0;
  /// [axis] root mean square of ln(ρ w + ε) less ln(model w + ε) over the measured cells (eqs. 18-20).
  std::vector<double> rms_sun, rms_fresnel, rms_diffraction;
  std::vector<double> rms_analytic;  ///< the same of the analytic model, over the cells it was fitted to
  int unfinished = 0;             ///< unknowns of eqs. 18-20 whose solver the iterations' limit has cut short
  double residual_explained = 0;  ///< share of the squared residual that the terms explain, 0 where none
  /// Of their ratios, beyond what a byte holds; of the odd ones weighted by the factor they are multiplied
  /// by.
  double residual_clamped_share = 0, residual_odd_clamped_share = 0;
  double seconds_residual = 0, seconds_analytic = 0;
  /// Reading the measurement; choosing the model, compacting and writing: of whoever does that.
  double seconds_read = 0, seconds_store = 0;
  std::size_t peak_memory_bytes = 0;  ///< of the whole process
  double seconds_table = 0, seconds_step1 = 0, seconds_step2 = 0, seconds_step3 = 0;
  std::size_t cells = 0, below_horizon = 0, measured = 0, extrapolated = 0, invalid = 0;  ///< of the grid
  std::size_t negative_values = 0;  ///< of the file, clamped to 0
  MeasuredSource source;            ///< what the measurement was converted from
  SeparationOptions options;        ///< as used

  [[nodiscard]] std::string brief() const;  ///< one line
  [[nodiscard]] std::string full() const;   ///< a table for people
  [[nodiscard]] std::string costs() const;  ///< two lines of it, of the time and memory it took
  /// Without timings the same input gives the same text, on any number of threads: what a `.sep` file stores.
  [[nodiscard]] std::string json(bool with_timings = true) const;
};

struct SeparationResult {
  SeparatedTables tables;
  SeparationReport report;
};

/// What separate() comes to hold of a measurement with so many wavelengths, about.
[[nodiscard]] std::uint64_t separation_memory_bytes(const SeparationOptions& options,
                                                    std::size_t wavelengths);

/// Never throws for what the data hold: `report.usable` tells. Invalid options are a programmer's error
/// (check problem() first).
SeparationResult separate(const MeasuredBrdf& measured, const SeparationOptions& options, Progress& progress);

}  // namespace spectrace
