// SPDX-License-Identifier: Apache-2.0
// A relative error that is asked for is the one that the image has, against a long render.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "renderer/error_trend.h"
#include "tests/support/reached_error.h"

namespace spectrace::test {
namespace {

class Quality : public ::testing::TestWithParam<const char*> {};

TEST_P(Quality, ARelativeErrorIsReachedAndNotOvershot) {
  constexpr double kWanted = 0.05;
  const ReachedError reached = render_until(GetParam(), kWanted);
  EXPECT_NEAR(reached.relative_error, kWanted, 0.25 * kWanted) << reached.samples << " samples";
}

INSTANTIATE_TEST_SUITE_P(Scenes, Quality, ::testing::Values("cornell_box", "glass_and_coats", "instances"),
                         [](const auto& test) { return std::string(test.param); });

TEST(ErrorTrend, AsksForWhatThePowerLawTakes) {
  ErrorTrend trend;
  trend.add(8, 0.4);
  EXPECT_DOUBLE_EQ(trend.samples_for(0.2), 32) << "with one measurement: independent samples";
  trend.add(12, 0.3);
  EXPECT_DOUBLE_EQ(trend.exponent(), 0.5) << "too near to tell a slope from";
  trend.add(16, 0.4 * std::pow(2, -0.75));
  EXPECT_NEAR(trend.exponent(), 0.75, 1e-12);
  EXPECT_NEAR(trend.samples_for(0.4 / 8), 128, 1e-9);
  trend.add(64, 0.5);
  EXPECT_DOUBLE_EQ(trend.exponent(), 0.5) << "an error that grows";
}

}  // namespace
}  // namespace spectrace::test
