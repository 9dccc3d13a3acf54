// SPDX-License-Identifier: Apache-2.0
#include "separation/split.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/math/math.h"
#include "separation/analytic_fit.h"
#include "tests/support/chi_square.h"
#include "tests/unit/separation/synthetic_cells.h"

namespace spectrace {
namespace {

double objective(double x, double mean, double diffuse, double specular, double eta_d, double eta_s) {
  return eta_d * std::abs(x - diffuse) + eta_s * std::abs(mean - x - specular);
}

SeparationOptions small_grid() {
  SeparationOptions options;
  options.grid = {.n_theta_h = 24, .n_theta_d = 12, .n_phi_d = 20};
  return options;
}

TEST(Split, NoPointOfTheIntervalIsBetterThanTheClosedForm) {
  test::TestRandom random(7);
  constexpr int kCells = 10'000, kScan = 200;
  for (int cell = 0; cell < kCells; ++cell) {
    const double mean = double(random.uniform()), diffuse = double(random.uniform()),
                 specular = double(random.uniform()) * 2;
    const double eta_d = cell % 2 == 0 ? 0.9 : 0.8, eta_s = cell % 2 == 0 ? 0.8 : 0.9;
    const double x = split_cell(mean, diffuse, specular, eta_d, eta_s);
    ASSERT_GE(x, 0);
    ASSERT_LE(x, mean);
    const double value = objective(x, mean, diffuse, specular, eta_d, eta_s);
    for (int i = 0; i <= kScan; ++i) {
      // The objective is convex and piecewise linear: a scan can only come closer to the optimum from above.
      ASSERT_LE(value, objective(mean * i / kScan, mean, diffuse, specular, eta_d, eta_s) + 1e-12);
    }
  }
}

TEST(Split, LambertPlusSpecularGivesTheMeanBackWhereItIsBrightEnough) {
  const SeparationOptions options = small_grid();
  const AnalyticFit fit{.albedo_d = 0.3, .rho_0 = 0.5, .f_0 = 0.2, .alpha = 0.2};
  const CellTable table = test::synthetic_cells(options, [&](double h, double d, double i, double o) {
    return fit.albedo_d / kPi64 + analytic_specular(fit, h, d, i, o);
  });
  const SplitResult split = split_lobes(table, fit, false, options);
  EXPECT_EQ(split.albedo_d, fit.albedo_d);
  EXPECT_LT(split.lambert_cost, 1e-6);  // float rounding of the table
  for (std::size_t i = 0; i < table.fitted(); ++i) {
    const double specular = double(split.rho_s[table.cell[i]]) / table.cos_sum(i);
    EXPECT_NEAR((fit.albedo_d / kPi64 + specular) / double(table.mean[i]), 1, 1e-5);
  }
}

TEST(Split, EveryNodeIsFilledAndThePolesDoNotDependOnAzimuth) {
  const SeparationOptions options = small_grid();
  const AnalyticFit fit{.albedo_d = 0.1, .rho_0 = 0.5, .f_0 = 0.2, .alpha = 0.3};
  CellTable table =
      test::synthetic_cells(options, [](double h, double, double i, double) { return 0.1 + h * i; });
  ASSERT_GT(table.counts.below_horizon, 0U);
  const SplitResult split = split_lobes(table, fit, false, options);
  EXPECT_TRUE(std::all_of(split.rho_s.begin(), split.rho_s.end(),
                          [](float x) { return std::isfinite(x) && x >= 0; }));
  for (int p = 1; p < options.grid.n_phi_d; ++p) {
    EXPECT_EQ(split.rho_s[options.grid.index(0, 5, p)], split.rho_s[options.grid.index(0, 5, 0)]);
    EXPECT_EQ(split.rho_s[options.grid.index(5, 0, p)], split.rho_s[options.grid.index(5, 0, 0)]);
  }
}

TEST(Split, APurelyDiffuseMaterialHasNoSpecularLobeAtAll) {
  const SeparationOptions options = small_grid();
  const AnalyticFit fit{.albedo_d = 0.5, .rho_0 = 0, .f_0 = 0, .alpha = 0.5};
  // 1e-5 of ripple, as interpolation leaves it
  const CellTable table = test::synthetic_cells(
      options, [](double h, double, double, double) { return 0.5 / kPi64 * (1 + 1e-5 * std::sin(40 * h)); });
  const SplitResult split = split_lobes(table, fit, false, options);
  EXPECT_TRUE(std::all_of(split.rho_s.begin(), split.rho_s.end(), [](float x) { return x == 0; }));
  EXPECT_EQ(split.albedo_d, 0.5);
}

TEST(Split, APurelySpecularMaterialHasNoDiffuseLobeAtAll) {
  const SeparationOptions options = small_grid();
  const AnalyticFit fit{.albedo_d = 1e-6, .rho_0 = 0.8, .f_0 = 0.9, .alpha = 0.3};
  const CellTable table = test::synthetic_cells(
      options, [&](double h, double d, double i, double o) { return analytic_specular(fit, h, d, i, o); });
  const SplitResult split = split_lobes(table, fit, false, options);
  EXPECT_EQ(split.albedo_d, 0);
  EXPECT_NEAR(split.specular_share, 1, 1e-12);
}

}  // namespace
}  // namespace spectrace
