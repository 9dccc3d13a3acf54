// SPDX-License-Identifier: Apache-2.0
#include "separation/separate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "core/base/cost.h"
#include "core/base/error.h"
#include "separation/analytic_fit.h"
#include "separation/analytic_spectra.h"
#include "separation/cell_table.h"
#include "separation/diffuse_colour.h"
#include "separation/parallel.h"
#include "separation/residual_fit.h"
#include "separation/spectral_fit.h"
#include "separation/split.h"

namespace spectrace {
namespace {

void judge(SeparationReport& report, bool isotropic, bool converged) {
  if (!isotropic) {
    report.verdict = "unusable: the material is anisotropic, the method separates isotropic ones";
  } else if (report.measured == 0) {
    report.verdict = "unusable: no cell of the table was measured";
  } else if (!converged) {
    report.verdict = "unusable: step 1 did not converge from any start";
  } else {
    report.verdict = fmt::format("usable: fitted to {} measured cells", report.measured);
    return;
  }
  report.usable = false;
}

SeparatedTables empty_tables(const MeasuredBrdf& measured, const HalfDifferenceGrid& grid) {
  const std::size_t n = measured.axis().size();
  SeparatedTables tables;
  tables.grid = grid;
  tables.axis = measured.axis();
  tables.c_d.resize(n);
  tables.s_sun.resize(n);
  tables.rho_s.resize(grid.size());
  tables.s_fresnel.resize(std::size_t(grid.n_theta_d) * n);
  tables.s_diffraction.resize(grid.angular_size() * n);
  return tables;
}

/// c_d = s_d alpha_d: the renderer's Lambert lobe.
void store(SpectralFit fit, SplitResult split, SeparationResult& result) {
  SeparatedTables& tables = result.tables;
  for (std::size_t k = 0; k < fit.s_d.size(); ++k) {
    tables.c_d[k] = static_cast<float>(double(fit.s_d[k]) * split.albedo_d);
  }
  tables.diffuse_shape = std::move(split.diffuse_shape);
  tables.rho_s = std::move(split.rho_s);
  tables.s_sun = std::move(fit.s_sun);
  tables.s_fresnel = std::move(fit.s_fresnel);
  tables.s_diffraction = std::move(fit.s_diffraction);
  result.report.rms_sun = std::move(fit.rms_sun);
  result.report.rms_fresnel = std::move(fit.rms_fresnel);
  result.report.rms_diffraction = std::move(fit.rms_diffraction);
}

// What an exact Lambert lobe may have too much before the measurement refutes it: three times the most that
// one of the true colour had over the acquired materials of known_truth_test, on the database's coarse grid.
// Of the real files the felts and matte paints exceed it: they are darker off the grazing half vectors than
// at them.
constexpr double kLargestExcess = 0.01;

/// c_d over its mean, which becomes the fit's alpha_d. Empty, and the fit untouched, where this is not asked
/// for, not found, not determined, or refuted: a Lambert lobe may not exceed the measurement, or no more than
/// that of eq. 7 does.
std::vector<float> dark_colour(const MeasuredBrdf& measured, const CellTable& table,
                               AnalyticSolution& analytic, const SeparationOptions& options) {
  if (options.colour != DiffuseColour::kDark || analytic.matte) return {};
  const FreeFresnelFit fit = fit_free_fresnel(table, options.epsilon, analytic.fit);
  if (!fit.converged) return {};
  std::optional<std::vector<float>> s_d = diffuse_colour(measured, table, fit);
  if (!s_d) return {};
  const double mean = std::reduce(s_d->begin(), s_d->end(), 0.0) / double(s_d->size());
  const double allowed = std::max(kLargestExcess, lambert_excess(table, analytic.fit.albedo_d));
  if (!(mean <= 1) || lambert_excess(table, mean) > allowed) return {};
  analytic.fit.albedo_d = mean;
  for (float& s : *s_d) s = mean > 0 ? static_cast<float>(double(s) / mean) : 0;
  return std::move(*s_d);
}

/// The largest alpha_d up to `albedo` that the measurement supports. Felts and matte paints are darker than
/// any Lambert lobe off the grazing half vectors; what such a lobe has too much no specular table can take
/// back.
double supported_albedo(const CellTable& table, double albedo) {
  if (lambert_excess(table, albedo) <= kSupportedExcess) return albedo;
  constexpr int kBisections = 12;  // to 0.03 %
  double lower = 0, upper = albedo;
  for (int i = 0; i < kBisections; ++i) {
    const double middle = (lower + upper) / 2;
    (lambert_excess(table, middle) > kSupportedExcess ? upper : lower) = middle;
  }
  return lower;
}

void run(const MeasuredBrdf& measured, const SeparationOptions& options, Progress& progress,
         SeparationResult& result) {
  SeparationReport& report = result.report;
  CellTable table;
  progress.update("table", 0, 1);
  report.seconds_table = seconds_of([&] { table = build_cell_table(measured, options); });
  report.cells = table.counts.cells;
  report.below_horizon = table.counts.below_horizon;
  report.measured = table.counts.measured;
  report.extrapolated = table.counts.extrapolated;
  report.invalid = table.counts.invalid;

  progress.update("analytic fit", 0, 1);
  AnalyticSolution analytic;
  report.seconds_step1 = seconds_of([&] { analytic = fit_analytic(table, options); });
  report.fit = analytic.fit;
  report.matte = analytic.matte;
  report.step1_initial_cost = analytic.initial_cost;
  report.step1_final_cost = analytic.final_cost;
  report.step1_gradient_max = analytic.gradient_max;
  report.step1_iterations = analytic.iterations;
  judge(report, measured.tables().is_isotropic(), analytic.converged);
  if (!report.usable) return;

  const AnalyticFit achromatic = analytic.fit;
  std::vector<float> s_d;
  report.seconds_step1 += seconds_of([&] {
    s_d = dark_colour(measured, table, analytic, options);
    if (bounds_diffuse_lobe(options) && !analytic.matte) {
      const double wanted = analytic.fit.albedo_d;
      analytic.fit.albedo_d = supported_albedo(table, wanted);
      report.albedo_scale = wanted > 0 ? analytic.fit.albedo_d / wanted : 1;
    }
  });
  report.dark_colour = !s_d.empty();

  SplitResult split;
  report.seconds_step2 =
      seconds_of([&] { split = split_lobes(table, analytic.fit, analytic.matte, options); });
  report.albedo_d = split.albedo_d;
  report.step2_cost = split.cost;
  report.lambert_cost = split.lambert_cost;
  report.specular_share = split.specular_share;

  SpectralFit spectra;
  report.seconds_step3 =
      seconds_of([&] { spectra = fit_spectra(measured, table, split, s_d, options, progress); });
  report.unfinished = spectra.unfinished;
  store(std::move(spectra), std::move(split), result);
  if (options.analytic) {
    progress.update("analytic model", 0, 1);
    report.seconds_analytic = seconds_of([&] {
      AnalyticSpectra spectra_fit = fit_analytic_spectra(measured, table, achromatic, options);
      result.tables.analytic = std::move(spectra_fit.parameters);
      report.rms_analytic = std::move(spectra_fit.rms);
    });
  }
  if (options.residual_rank == 0) return;

  progress.update("residual", 0, 1);
  ResidualReport residual;
  report.seconds_residual =
      seconds_of([&] { result.tables.residual = fit_residual(measured, result.tables, options, residual); });
  report.residual_explained = residual.explained;
  report.residual_clamped_share = residual.clamped_share;
  report.residual_odd_clamped_share = residual.odd_clamped_share;
}

}  // namespace

std::string SeparationOptions::problem() const {
  const auto positive = [](double x) { return std::isfinite(x) && x > 0; };
  for (const int nodes : {grid.n_theta_h, grid.n_theta_d, grid.n_phi_d}) {
    if (nodes < 2 || std::size_t(nodes) > HalfDifferenceGrid::kMaxDimension) {
      return fmt::format("grid: each dimension must lie in [2, {}]", HalfDifferenceGrid::kMaxDimension);
    }
  }
  if (grid.size() > kMaxCells) return fmt::format("grid: at most {} cells", kMaxCells);
  if (!positive(epsilon)) return "epsilon must be > 0";
  if (starts < 1) return "starts must be at least 1";
  if (!(std::isfinite(diffraction_prior) && diffraction_prior >= 0)) return "diffraction_prior must be >= 0";
  if (residual_rank < 0 || residual_rank > int(kMaxResidualRank)) {
    return fmt::format("residual_rank must lie in [0, {}]", kMaxResidualRank);
  }
  if (threads < 0) return "threads must be >= 0";
  return {};
}

std::uint64_t separation_memory_bytes(const SeparationOptions& options, std::size_t wavelengths) {
  // Seen between grids of 60 x 60 x 90 and 120 x 120 x 180 cells: 211 bytes a cell at 3 wavelengths, 369 at
  // 195, of which a block of them is held at a time.
  constexpr std::uint64_t kBytesACell = 180, kBytesAWavelength = 10, kMostWavelengths = 16;
  return options.grid.size() *
         (kBytesACell + kBytesAWavelength * std::min<std::uint64_t>(wavelengths, kMostWavelengths));
}

SeparationResult separate(const MeasuredBrdf& measured, const SeparationOptions& options,
                          Progress& progress) {
  SPECTRACE_CHECK(options.problem().empty());
  SeparationResult result;
  result.tables = empty_tables(measured, options.grid);
  result.tables.source_name = measured.tables().description;
  result.report.options = options;
  result.report.source = measured.tables().source;
  result.report.negative_values = measured.tables().negative_values;
  with_threads(options.threads, [&] { run(measured, options, progress, result); });
  result.tables.report_json = result.report.json(false);
  return result;
}

}  // namespace spectrace
