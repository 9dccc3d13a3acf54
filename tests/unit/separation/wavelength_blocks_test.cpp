// SPDX-License-Identifier: Apache-2.0
// Step 3 works on blocks of wavelengths; no wavelength may feel which others share its block.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <vector>

#include "materials/acquisition.h"
#include "materials/analytic_brdf.h"
#include "materials/material.h"
#include "separation/analytic_fit.h"
#include "separation/cell_table.h"
#include "separation/spectral_fit.h"
#include "separation/split.h"

namespace spectrace {
namespace {

constexpr std::size_t kWavelengths = 19;  // a block of 16 and a short one

/// Lambert + GGX whose colours differ at every wavelength.
MeasuredTables colourful() {
  AcquisitionOptions options;
  options.lambda_nm.clear();
  std::vector<float> parameters(4 * kWavelengths);
  for (std::size_t k = 0; k < kWavelengths; ++k) {
    options.lambda_nm.push_back(400 + 15 * float(k));
    parameters[k] = 0.1F + 0.02F * float(k * 7 % kWavelengths);
    parameters[kWavelengths + k] = 0.2F + 0.05F * float(k * 11 % kWavelengths);
    parameters[2 * kWavelengths + k] = 0.3F;
    parameters[3 * kWavelengths + k] = 0.25F;
  }
  SilentProgress progress;
  const AnalyticBrdf brdf(SpectralAxis::wavelengths(options.lambda_nm), parameters);
  return acquire(Material(brdf), options, progress);
}

/// The same measurement with the wavelengths [first, 19) alone.
MeasuredTables from(const MeasuredTables& all, std::size_t first) {
  MeasuredTables part = all;
  const auto lambda_nm = all.axis.lambda_nm();
  part.axis = SpectralAxis::wavelengths({lambda_nm.begin() + std::ptrdiff_t(first), lambda_nm.end()});
  part.spectra.clear();
  const std::size_t cells = std::size_t(all.table_size) * std::size_t(all.table_size);
  for (std::size_t slice = 0; slice < all.slices(); ++slice) {
    const auto begin = all.spectra.begin() + std::ptrdiff_t((slice * kWavelengths + first) * cells);
    part.spectra.insert(part.spectra.end(), begin, begin + std::ptrdiff_t((kWavelengths - first) * cells));
  }
  return part;
}

TEST(WavelengthBlocks, TheLastShortBlockIsFittedAsIfAlone) {
  constexpr std::size_t kFirst = 12;
  const MeasuredTables all = colourful();
  const MeasuredBrdf whole(all), part(from(all, kFirst));
  SeparationOptions options;
  options.grid = {.n_theta_h = 24, .n_theta_d = 20, .n_phi_d = 18};
  const CellTable table = build_cell_table(whole, options);
  const AnalyticSolution analytic = fit_analytic(table, options);
  ASSERT_TRUE(analytic.converged);
  const SplitResult split = split_lobes(table, analytic.fit, analytic.matte, options);
  SilentProgress progress;
  const SpectralFit together = fit_spectra(whole, table, split, {}, options, progress);
  const SpectralFit apart = fit_spectra(part, table, split, {}, options, progress);

  const std::size_t n = kWavelengths, m = kWavelengths - kFirst;
  // The searches stop at 1e-5 of ln s, after sums in another order of lanes.
  const auto expect_same = [](float a, float b) { EXPECT_NEAR(a, b, 1e-4F * std::max(a, 0.01F)); };
  for (std::size_t k = 0; k < m; ++k) {
    expect_same(together.s_d[kFirst + k], apart.s_d[k]);
    expect_same(together.s_sun[kFirst + k], apart.s_sun[k]);
    for (std::size_t d = 0; d < std::size_t(options.grid.n_theta_d); ++d) {
      expect_same(together.s_fresnel[d * n + kFirst + k], apart.s_fresnel[d * m + k]);
    }
    for (std::size_t group = 0; group < options.grid.angular_size(); ++group) {
      expect_same(together.s_diffraction[group * n + kFirst + k], apart.s_diffraction[group * m + k]);
    }
  }
  EXPECT_NE(together.s_sun[kFirst], together.s_sun[kFirst + 1]);  // there is something to tell apart
}

}  // namespace
}  // namespace spectrace
