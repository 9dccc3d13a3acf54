// SPDX-License-Identifier: Apache-2.0
#include "core/math/angles.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/math/math.h"

namespace spectrace {
namespace {

constexpr double kTolerance = 1e-11;  // as stated

TEST(Angles, AreThoseOfTheLibrary) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> exponent(-40, 3);
  for (int i = 0; i < 100000; ++i) {
    const double y = std::exp(exponent(random)), x = std::exp(exponent(random));
    const DoublePair angles = first_quadrant_angles(DoublePair{y, x}, DoublePair{x, y});
    ASSERT_NEAR(angles[0], std::atan2(y, x), kTolerance) << y << ", " << x;
    ASSERT_NEAR(angles[1], std::atan2(x, y), kTolerance) << x << ", " << y;
  }
}

TEST(Angles, AreExactOnTheAxes) {
  const DoublePair axes = first_quadrant_angles(DoublePair{0, 2}, DoublePair{3, 0});
  EXPECT_EQ(axes[0], 0);
  EXPECT_EQ(axes[1], kPi64 / 2);
  EXPECT_EQ(first_quadrant_angles(DoublePair{0, 0}, DoublePair{0, 1})[0], 0);
}

}  // namespace
}  // namespace spectrace
