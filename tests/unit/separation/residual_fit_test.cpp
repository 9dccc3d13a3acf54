// SPDX-License-Identifier: Apache-2.0
#include "separation/residual_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <memory>

#include "core/math/math.h"
#include "materials/acquisition.h"
#include "materials/choose_model.h"
#include "materials/material.h"
#include "separation/fill_grid.h"
#include "separation/separate.h"
#include "separation/tabulate.h"
#include "tests/support/acquired.h"

namespace spectrace {
namespace {

SeparationOptions coarse(int residual_rank) {
  SeparationOptions options;
  options.grid = {.n_theta_h = 45, .n_theta_d = 30, .n_phi_d = 36};
  options.residual_rank = residual_rank;
  return options;
}

using test::acquired;

TEST(ResidualFit, BringsTheModelToTheTableItself) {
  const MeasuredBrdf measured = acquired("pearlescent", {400, 460, 520, 580, 640, 700});
  SilentProgress progress;
  const SeparationResult result = separate(measured, coarse(6), progress);
  EXPECT_GT(result.report.residual_explained, 0.99);
  EXPECT_LT(result.report.residual_clamped_share, 1e-3);
  const HalfDifferenceTable x = tabulate(measured, coarse(0));
  const ResidualTable& residual = result.tables.residual;
  const std::size_t n = x.axis.size();
  double left = 0, of = 0;
  for (int h = 1; h < x.grid.n_theta_h; ++h) {
    for (int d = 1; d < x.grid.n_theta_d; ++d) {
      for (int p = 0; p < x.grid.n_phi_d; ++p) {
        const DirectionPair pair =
            from_half_difference({x.grid.theta_h(h), x.grid.theta_d(d), x.grid.phi_d(p)});
        if (!(pair.wo.z > 0.05 && pair.wi.z > 0.05)) continue;
        const std::size_t cell = x.grid.index(h, d, p), group = cell / std::size_t(x.grid.n_phi_d);
        const double diffuse = double(pair.wo.z + pair.wi.z) / kPi64;
        double mean_albedo = 0;
        for (float c : result.tables.c_d) mean_albedo += double(c) / double(n);
        const double m = mean_albedo * diffuse + double(result.tables.rho_s[cell]);
        for (std::size_t k = 0; k < n; ++k) {
          const double model =
              double(result.tables.c_d[k]) * diffuse +
              double(result.tables.rho_s[cell]) * double(result.tables.s_diffraction[group * n + k]);
          double ratio = 0;
          for (std::size_t t = 0; t < residual.rank; ++t) {
            ratio += double(residual.ratio[cell * residual.rank + t]) * double(residual.step) *
                     double(residual.basis[t * n + k]);
          }
          const double truth = double(x.q[cell * n + k]);
          left += std::pow((model + m * ratio - truth) / m, 2);
          of += std::pow((model - truth) / m, 2);
        }
      }
    }
  }
  EXPECT_LT(left, 0.02 * of);  // six terms for six wavelengths: rounding to bytes is left
}

/// Mean relative error of f cosθi over pairs in either order.
double error_of(const SeparatedBrdf& model, const MeasuredBrdf& measured) {
  std::array<Float, kLanes> nm{}, pdf{};
  nm.fill(550);
  pdf.fill(1);
  const SampledWavelengths lambda(nm, pdf);
  const ShadingPoint at{.lambda = lambda};
  double sum = 0;
  int count = 0;
  for (double to = 0.1; to < 1.2; to += 0.17) {
    for (double ti = 0.05; ti < 1.2; ti += 0.19) {
      for (double phi = 0.05; phi < 6.2; phi += 0.41) {
        const Vec3 wo{Float(std::sin(to)), 0, Float(std::cos(to))};
        const Vec3 wi{Float(std::sin(ti) * std::cos(phi)), Float(std::sin(ti) * std::sin(phi)),
                      Float(std::cos(ti))};
        const double truth = double(measured.evaluate(wo, wi, at).value_cos[0]);
        sum += std::abs(double(model.evaluate(wo, wi, at).value_cos[0]) / truth - 1);
        ++count;
      }
    }
  }
  return sum / count;
}

TEST(ResidualFit, KeepsWhatIsNotReciprocalUnlessToldNotTo) {
  const MeasuredBrdf measured = test::not_reciprocal();
  SilentProgress progress;
  const auto fit = [&](bool reciprocal) {
    SeparationOptions options = coarse(4);
    options.reciprocal = reciprocal;
    return std::make_shared<const SeparatedTables>(separate(measured, options, progress).tables);
  };
  const auto both = fit(false), one = fit(true);
  EXPECT_FALSE(both->residual.odd.empty());
  EXPECT_TRUE(one->residual.odd.empty());
  const double with_odd = error_of(SeparatedBrdf(both, SeparationModel::kResidual), measured);
  const double without = error_of(SeparatedBrdf(one, SeparationModel::kResidual), measured);
  EXPECT_LT(with_odd, 0.02);
  EXPECT_GT(without, 2 * with_odd);
}

TEST(FillGrid, TheOddPartGoesOnWithTheOtherSignAndVanishesAtThePoles) {
  const HalfDifferenceGrid grid{.n_theta_h = 3, .n_theta_d = 3, .n_phi_d = 8};
  std::vector<float> table(grid.size(), 1.0F);
  table[grid.index(1, 1, 0)] = kNoValue;  // its neighbours: 1 at phi_d = 1, and 1 at 7, on the other side
  for (const int p : {6, 7}) table[grid.index(2, 1, p)] = kNoValue;
  fill_unmeasured_odd(grid, table);
  EXPECT_EQ(table[grid.index(1, 1, 0)], 0);
  EXPECT_EQ(table[grid.index(2, 1, 6)], 1);
  EXPECT_EQ(table[grid.index(2, 1, 7)], -1);
  for (int p = 0; p < grid.n_phi_d; ++p) {
    EXPECT_EQ(table[grid.index(0, 2, p)], 0);
    EXPECT_EQ(table[grid.index(2, 0, p)], 0);
  }
}

TEST(ChooseModel, TakesTheCheapestWithinTheTolerance) {
  const MeasuredBrdf measured = acquired("pearlescent");
  SilentProgress progress;
  const auto tables = std::make_shared<const SeparatedTables>(separate(measured, coarse(4), progress).tables);
  std::vector<double> errors;
  for (int m = 0; m < 4; ++m)
    errors.push_back(model_error(measured, tables, static_cast<SeparationModel>(m)));
  EXPECT_LT(errors[1], errors[0]);  // a film's colour turns with theta_d
  EXPECT_LT(errors[3], errors[2]);  // and the residual adds to the model it starts from
  for (const double tolerance : errors) {
    const auto cheapest =
        std::find_if(errors.begin(), errors.end(), [&](double e) { return e <= tolerance; });
    const ModelChoice choice = choose_model(measured, tables, tolerance);
    EXPECT_EQ(choice.model, static_cast<SeparationModel>(cheapest - errors.begin()));
    EXPECT_TRUE(choice.within_tolerance);
    EXPECT_EQ(choice.errors.size(), std::size_t(cheapest - errors.begin()) + 1);
  }
  // Without the measurement: the richest model, off by nothing from itself, stands for it.
  EXPECT_EQ(choose_model(tables, 0).model, SeparationModel::kResidual);
  EXPECT_EQ(choose_model(tables, 1).model, SeparationModel::kSun);
  const ModelChoice middle = choose_model(tables, errors[0] / 2);
  EXPECT_EQ(middle.model, SeparationModel::kFresnel);
  EXPECT_NEAR(middle.errors[0], errors[0], errors[3] + errors[0] / 10);  // the triangle's inequality
  const ModelChoice none = choose_model(measured, tables, 0);
  EXPECT_EQ(none.model, SeparationModel::kResidual);
  EXPECT_FALSE(none.within_tolerance);
}

TEST(ModelError, IsZeroForTheMaterialItself) {
  // A Lambert measured and separated as matte: only the measurement's own interpolation is left.
  const MeasuredBrdf measured = acquired("matte");
  SilentProgress progress;
  const auto tables = std::make_shared<const SeparatedTables>(separate(measured, coarse(0), progress).tables);
  EXPECT_LT(model_error(measured, tables, SeparationModel::kSun), 0.05);
}

}  // namespace
}  // namespace spectrace
