// SPDX-License-Identifier: Apache-2.0
#include "separation/analytic_fit.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/math/math.h"
#include "tests/unit/separation/synthetic_cells.h"

namespace spectrace {
namespace {

/// Eqs. 12-15 letter by letter; dies of tan θ and cos θ near the horizon, where analytic_specular must not.
double ggx_as_printed(const AnalyticFit& fit, double cos_h, double cos_d, double cos_i, double cos_o) {
  const double a2 = fit.alpha * fit.alpha;
  const double f = fit.f_0 + (1 - fit.f_0) * std::pow(1 - cos_d, 5);
  const double t = (a2 - 1) * cos_h * cos_h + 1;
  const double d = a2 / (kPi64 * t * t);
  const auto g = [&](double c) { return 2 / (1 + std::sqrt(1 + a2 * (1 - c * c) / (c * c))); };
  return fit.rho_0 * f * d * g(cos_i) * g(cos_o) / (4 * cos_i * cos_o);
}

SeparationOptions small_grid() {
  SeparationOptions options;
  options.grid = {.n_theta_h = 30, .n_theta_d = 18, .n_phi_d = 24};
  return options;
}

CellTable material(const AnalyticFit& fit, const SeparationOptions& options) {
  return test::synthetic_cells(options, [&](double h, double d, double i, double o) {
    return fit.albedo_d / kPi64 + analytic_specular(fit, h, d, i, o);
  });
}

TEST(AnalyticFit, GgxIsWhatThePaperPrints) {
  const AnalyticFit fit{.albedo_d = 0, .rho_0 = 0.7, .f_0 = 0.3, .alpha = 0.15};
  for (double cos_i : {0.05, 0.4, 1.0}) {
    for (double cos_o : {0.1, 0.9}) {
      for (double cos_h : {0.3, 0.99, 1.0}) {
        const double expected = ggx_as_printed(fit, cos_h, 0.6, cos_i, cos_o);
        EXPECT_NEAR(analytic_specular(fit, cos_h, 0.6, cos_i, cos_o) / expected, 1, 1e-12);
      }
    }
  }
  EXPECT_TRUE(std::isfinite(analytic_specular(fit, 0.01, 0.01, 1e-12, 1e-12)));
}

TEST(AnalyticFit, GradientAgreesWithDifferences) {
  const SeparationOptions options = small_grid();
  const LobeCells cells = lobe_cells(
      material({.albedo_d = 0.4, .rho_0 = 0.6, .f_0 = 0.2, .alpha = 0.2}, options), options.epsilon, 1);
  constexpr double kStep = 1e-5;
  // Central differences of an O(1) second derivative: step² times the third derivative, plus rounding / step.
  constexpr double kTolerance = 1e-6;
  for (const AnalyticFit& at : {AnalyticFit{.albedo_d = 0.3, .rho_0 = 0.9, .f_0 = 0.4, .alpha = 0.35},
                                AnalyticFit{.albedo_d = 0.6, .rho_0 = 0.2, .f_0 = 0.05, .alpha = 0.05}}) {
    const FitVector x = to_vector(at);
    const FitEquations equations = fit_equations(cells, options.epsilon, x);
    for (std::size_t i = 0; i < x.size(); ++i) {
      FitVector low = x, high = x;
      low[i] -= kStep;
      high[i] += kStep;
      const double difference = (fit_equations(cells, options.epsilon, high).cost -
                                 fit_equations(cells, options.epsilon, low).cost) /
                                (2 * kStep);
      EXPECT_NEAR(equations.gradient[i] / difference, 1, kTolerance) << "parameter " << i;
    }
  }
}

TEST(AnalyticFit, RecoversTheParametersOfAnExactTable) {
  const SeparationOptions options = small_grid();
  const std::array<AnalyticFit, 3> truths{
      AnalyticFit{.albedo_d = 0.3, .rho_0 = 0.5, .f_0 = 0.1, .alpha = 0.15},
      AnalyticFit{.albedo_d = 0.05, .rho_0 = 0.9, .f_0 = 0.6, .alpha = 0.05},
      AnalyticFit{.albedo_d = 0.7, .rho_0 = 0.4, .f_0 = 0.04, .alpha = 0.5}};
  // The table holds floats: 6e-8 a cell, amplified by the weak coupling of F_0 and rho_0.
  constexpr double kRecovery = 1e-4;
  for (const AnalyticFit& truth : truths) {
    const AnalyticSolution solution = fit_analytic(material(truth, options), options);
    ASSERT_TRUE(solution.converged);
    EXPECT_NEAR(solution.fit.albedo_d, truth.albedo_d, kRecovery);
    EXPECT_NEAR(solution.fit.rho_0, truth.rho_0, kRecovery);
    EXPECT_NEAR(solution.fit.f_0, truth.f_0, kRecovery);
    EXPECT_NEAR(solution.fit.alpha, truth.alpha, kRecovery);
    EXPECT_LT(solution.gradient_max, 1e-9);
  }
}

TEST(AnalyticFit, AMatteMaterialHasNoSpecularTerm) {
  const SeparationOptions options = small_grid();
  const AnalyticSolution matte = fit_analytic(
      test::synthetic_cells(
          options, [](double h, double, double, double) { return 0.1 * (1 + 0.03 * std::sin(9 * h)); }),
      options);
  EXPECT_TRUE(matte.matte);
  EXPECT_EQ(matte.fit.rho_0, 0);
  EXPECT_NEAR(matte.fit.albedo_d, 0.1 * kPi64, 0.01);
  // A weak highlight is enough not to be matte.
  EXPECT_FALSE(
      fit_analytic(material({.albedo_d = 0.3, .rho_0 = 0.2, .f_0 = 0.04, .alpha = 0.2}, options), options)
          .matte);
}

TEST(AnalyticFit, StaysInsideItsBoundsOnMaterialsTheModelCannotReach) {
  const SeparationOptions options = small_grid();
  for (double level : {0.0, 1e-6, 10.0}) {
    const AnalyticSolution solution = fit_analytic(
        test::synthetic_cells(options, [&](double, double, double, double) { return level; }), options);
    EXPECT_TRUE(solution.converged) << level;
    EXPECT_GE(solution.fit.albedo_d, 0);
    EXPECT_LE(solution.fit.albedo_d, 1);
    EXPECT_GE(solution.fit.rho_0, 0);
    EXPECT_GE(solution.fit.f_0, 0);
    EXPECT_LE(solution.fit.f_0, 1);
    EXPECT_GE(solution.fit.alpha, 1e-3);
    EXPECT_LE(solution.fit.alpha, 1);
    EXPECT_TRUE(std::isfinite(solution.final_cost));
  }
}

}  // namespace
}  // namespace spectrace
