// SPDX-License-Identifier: Apache-2.0
#include "separation/tabulate.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>

#include "materials/plain_table_brdf.h"
#include "tests/support/acquired.h"

namespace spectrace {
namespace {

const MeasuredBrdf& measured() {
  static const MeasuredBrdf brdf = test::acquired("glossy", {500, 600});
  return brdf;
}

SampledWavelengths at_500_nm() {
  std::array<Float, kLanes> nm{}, pdf{};
  nm.fill(500);
  pdf.fill(1);
  return {nm, pdf};
}

const SeparationOptions& coarse() {
  static const SeparationOptions options = [] {
    SeparationOptions o;
    o.grid = {.n_theta_h = 30, .n_theta_d = 30, .n_phi_d = 36};
    return o;
  }();
  return options;
}

/// At a node nothing is interpolated: there every table holds what the file says.
template <typename Brdf>
void expect_the_file_at_nodes(const MeasuredBrdf& file, const Brdf& brdf, bool both_orders) {
  const SampledWavelengths lambda = at_500_nm();
  const ShadingPoint at{.lambda = lambda};
  const HalfDifferenceGrid& grid = coarse().grid;
  int compared = 0;
  for (int h = 1; h < grid.n_theta_h; h += 3) {
    for (int d = 1; d < grid.n_theta_d; d += 3) {
      for (int p = 1; p < grid.n_phi_d; p += 5) {
        const DirectionPair pair = from_half_difference({grid.theta_h(h), grid.theta_d(d), grid.phi_d(p)});
        if (!(pair.wo.z > 0.3 && pair.wi.z > 0.3)) continue;
        const double there = double(file.evaluate(pair.wo, pair.wi, at).value_cos[0]) / double(pair.wi.z);
        const double back = double(file.evaluate(pair.wi, pair.wo, at).value_cos[0]) / double(pair.wo.z);
        const double cosines = double(pair.wo.z) + double(pair.wi.z);
        const double expected =
            both_orders ? (there * double(pair.wi.z) + back * double(pair.wo.z)) / cosines : there;
        const double found = double(brdf.evaluate(pair.wo, pair.wi, at).value_cos[0]) / double(pair.wi.z);
        // Angles go through single precision on their way: beside a steep highlight that tells.
        EXPECT_NEAR(found, expected, 2e-3 * expected) << h << ' ' << d << ' ' << p;
        ++compared;
      }
    }
  }
  EXPECT_GT(compared, 50);
}

TEST(Tabulate, HoldsTheMeanOfBothOrdersAtItsNodes) {
  expect_the_file_at_nodes(
      measured(), TabulatedBrdf(std::make_shared<const HalfDifferenceTable>(tabulate(measured(), coarse()))),
      true);
}

TEST(Tabulate, TheOrientedTableHoldsEachOrderAtItsNodes) {
  const MeasuredBrdf file = test::not_reciprocal();
  const auto table = std::make_shared<const HalfDifferenceTable>(tabulate_oriented(file, coarse()));
  expect_the_file_at_nodes(file, TabulatedBrdf(table), false);
}

TEST(Tabulate, OddTermsAreThereOnlyWhereBothOrdersWereMeasured) {
  const MeasuredBrdf file = test::not_reciprocal();
  const HalfDifferenceTable table = tabulate_oriented(file, coarse());
  const HalfDifferenceGrid& grid = table.grid;
  int both = 0, not_both = 0;
  for (int h = 1; h < grid.n_theta_h; ++h) {
    for (int d = 1; d < grid.n_theta_d; ++d) {
      for (int p = 0; p < grid.n_phi_d; ++p) {
        const DirectionPair pair = from_half_difference({grid.theta_h(h), grid.theta_d(d), grid.phi_d(p)});
        if (!(pair.wo.z > 0 && pair.wi.z > 0)) continue;
        const auto there = file.footprint(pair.wo, pair.wi), back = file.footprint(pair.wi, pair.wo);
        if (there && back && there->measured && back->measured) {
          ++both;
        } else {
          ++not_both;
          EXPECT_EQ(table.odd[grid.index(h, d, p) * table.axis.size()], 0) << h << ' ' << d << ' ' << p;
        }
      }
    }
  }
  EXPECT_GT(both, 1000);
  EXPECT_GT(not_both, 300);
}

TEST(Tabulate, ThePlainTableHoldsOneOrderAtItsNodes) {
  const auto table = std::make_shared<const HalfDifferenceTable>(tabulate_plain(measured(), coarse()));
  expect_the_file_at_nodes(measured(), PlainTableBrdf(table), false);
  EXPECT_TRUE(std::isnan(table->q[table->grid.index(29, 29, 0) * 2])) << "below the horizon there is nothing";
}

TEST(Tabulate, ThePlainTableIsFiniteEverywhereAboveTheHorizon) {
  const PlainTableBrdf brdf(
      std::make_shared<const HalfDifferenceTable>(tabulate_plain(measured(), coarse())));
  const SampledWavelengths lambda = at_500_nm();
  const ShadingPoint at{.lambda = lambda};
  for (double theta = 0; theta < 1.5707; theta += 0.01) {
    const Vec3 wo{Float(std::sin(theta)), 0, Float(std::cos(theta))};
    for (double phi = 0; phi < 6.3; phi += 0.3) {
      const Vec3 wi{Float(std::sin(theta) * std::cos(phi)), Float(std::sin(theta) * std::sin(phi)),
                    Float(std::cos(theta))};
      const Float value = brdf.evaluate(wo, wi, at).value_cos[0];
      EXPECT_TRUE(std::isfinite(value) && value >= 0) << theta << ' ' << phi;
    }
  }
}

}  // namespace
}  // namespace spectrace
