// SPDX-License-Identifier: Apache-2.0
#include "separation/supported_colour.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/math/math.h"
#include "separation/separate.h"
#include "separation/spectral_fit.h"
#include "separation/split.h"
#include "tests/support/acquired.h"

namespace spectrace::test {
namespace {

/// Of the light of one channel, the share that a Lambert lobe of this colour has too much: over the cells
/// that the solver takes, one in seven, in double.
double excess(const CellTable& table, const MeasuredBrdf& measured, std::size_t k, double colour) {
  const auto n_d = std::size_t(table.grid.n_theta_d);
  double missing = 0, total = 0;
  for (std::size_t group = 0; group < table.grid.angular_size(); ++group) {
    const CellRange cells = cells_of_group(table, group, 7);
    for (std::size_t i = cells.first; i < cells.end; i += cells.stride) {
      double x = 0;
      for (std::size_t n = table.node_begin[i]; n < table.node_begin[i + 1]; ++n) {
        x += double(table.node_weight[n]) * double(measured.spectrum(table.node_row[n])[k]);
      }
      x /= double(table.weight[i]);
      const double scale = node_measure(table.grid, group / n_d, group % n_d) * table.cos_sum(i);
      total += scale * x;
      missing += scale * std::max(colour / kPi64 - x, 0.0);
    }
  }
  return missing / total;
}

TEST(SupportedColour, IsAsBrightAsTheMeasurementAllowsAndNoBrighter) {
  const MeasuredBrdf measured = acquired("matte", {450, 550, 650});
  SeparationOptions options;
  options.grid = {.n_theta_h = 30, .n_theta_d = 20, .n_phi_d = 30};
  const CellTable table = build_cell_table(measured, options);
  std::vector<float> lobe(table.fitted()), specular(table.fitted()), log_data(table.fitted() * kStrip);
  for (std::size_t i = 0; i < table.fitted(); ++i) {
    lobe[i] = static_cast<float>(double(table.weight[i]) / kPi64);
    for (std::size_t k = 0; k < 3; ++k) {
      double x = 0;
      for (std::size_t n = table.node_begin[i]; n < table.node_begin[i + 1]; ++n) {
        x += double(table.node_weight[n]) * double(measured.spectrum(table.node_row[n])[k]);
      }
      log_data[i * kStrip + k] = static_cast<float>(std::log(x + options.epsilon));
    }
  }
  StripProblem problem{.table = table,
                       .diffuse = lobe.data(),
                       .specular = specular.data(),
                       .log_data = log_data.data(),
                       .epsilon = static_cast<float>(options.epsilon)};
  problem.s_d = {0.9F, 0.9F, 0.001F};  // twice too bright, twice too bright, dark
  EXPECT_TRUE(support_colour(problem, 3));
  for (const std::size_t k : {std::size_t(0), std::size_t(1)}) {
    EXPECT_LT(problem.s_d[k], 0.9F);
    EXPECT_NEAR(excess(table, measured, k, double(problem.s_d[k])), kSupportedExcess,
                0.011 * kSupportedExcess)
        << k;
  }
  EXPECT_EQ(problem.s_d[2], 0.001F) << "what is supported stays as it is";
  EXPECT_FALSE(support_colour(problem, 3)) << "and what has been lowered is supported";
}

}  // namespace
}  // namespace spectrace::test
