// SPDX-License-Identifier: Apache-2.0
// What tests/render/quality_test.cpp shows, for one percent.
#include <gtest/gtest.h>

#include <string>

#include "tests/support/reached_error.h"

namespace spectrace::test {
namespace {

class OnePercent : public ::testing::TestWithParam<const char*> {};

TEST_P(OnePercent, IsReachedAndNotOvershot) {
  constexpr double kWanted = 0.01;
  const ReachedError reached = render_until(GetParam(), kWanted);
  EXPECT_NEAR(reached.relative_error, kWanted, 0.25 * kWanted) << reached.samples << " samples";
  std::printf("%s: %.5f after %d samples\n", GetParam(), reached.relative_error, int(reached.samples));
}

INSTANTIATE_TEST_SUITE_P(Scenes, OnePercent, ::testing::Values("cornell_box", "glass_and_coats", "instances"),
                         [](const auto& test) { return std::string(test.param); });

}  // namespace
}  // namespace spectrace::test
