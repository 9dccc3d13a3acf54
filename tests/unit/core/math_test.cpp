// SPDX-License-Identifier: Apache-2.0
#include "core/math/math.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "core/math/piecewise_linear.h"
#include "core/math/vec.h"

namespace spectrace {
namespace {

constexpr double kEpsilon = std::numeric_limits<Float>::epsilon();
const Float kNan = std::numeric_limits<Float>::quiet_NaN();

TEST(Math, SafeSqrtIsZeroBelowItsDomain) {
  EXPECT_EQ(safe_sqrt(4), 2);
  EXPECT_EQ(safe_sqrt(0), 0);
  EXPECT_EQ(safe_sqrt(-1e-7f), 0);
  EXPECT_EQ(safe_sqrt(kNan), 0);
}

TEST(Math, SafeAcosClampsItsArgument) {
  EXPECT_EQ(safe_acos(1.000001f), 0);
  EXPECT_FLOAT_EQ(safe_acos(-1.000001f), kPi);
  EXPECT_FLOAT_EQ(safe_acos(0), kPi / 2);
}

TEST(Math, SafeDivisionByZeroIsZero) {
  EXPECT_EQ(safe_div(1, 0), 0);
  EXPECT_EQ(safe_div(0, 0), 0);
  EXPECT_EQ(safe_div(1, 4), 0.25f);
}

TEST(Math, PowerHeuristicWeightsSumToOneOverTheWholeRange) {
  const std::vector<Float> pdfs{1e-30f, 1e-10f, 1, 1e10f, 1e30f};
  for (const Float a : pdfs) {
    for (const Float b : pdfs) {
      EXPECT_NEAR(power_heuristic(a, b) + power_heuristic(b, a), 1, kEpsilon) << a << " " << b;
    }
  }
  EXPECT_EQ(power_heuristic(1, 0), 1);
  EXPECT_FLOAT_EQ(power_heuristic(2, 1), 0.8f);  // 4 / (4 + 1): Veach 1997, eq. 9.13
}

TEST(Math, InvertLinearInvertsIntegrateLinear) {
  for (const double a : {0.0, 1e-12, 1.0, 3.0}) {
    for (const double b : {0.0, 1e-12, 1.0, 3.0}) {
      if (a + b == 0) continue;
      for (const double t : {0.0, 1e-9, 0.25, 0.5, 0.75, 1.0}) {
        const double area = integrate_linear(a, b, t);
        // In area, the quantity that is exact: where the density vanishes, t is ill-determined.
        EXPECT_NEAR(integrate_linear(a, b, invert_linear(a, b, area)), area, 4e-16 * std::max(a, b))
            << a << " " << b << " " << t;
      }
    }
  }
  EXPECT_EQ(invert_linear(0, 0, 0), 0);
  EXPECT_EQ(invert_linear(1, 0, 0.7), 1) << "an area beyond the whole is the whole";
}

TEST(Vec, FrameIsOrthonormalAndRightHandedForAnyNormal) {
  std::vector<Vec3> normals{{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {0, -1, 0}, normalize({1e-4f, -1e-4f, -1})};
  for (int i = 0; i < 100; ++i) {
    normals.push_back(normalize({std::sin(Float(i)), std::cos(Float(3 * i)), std::sin(Float(7 * i + 1))}));
  }
  for (const Vec3 n : normals) {
    const Frame f = Frame::from_normal(n);
    EXPECT_NEAR(dot(f.s, f.t), 0, 4 * kEpsilon);
    EXPECT_NEAR(dot(f.s, f.n), 0, 4 * kEpsilon);
    EXPECT_NEAR(dot(f.t, f.n), 0, 4 * kEpsilon);
    EXPECT_NEAR(length(f.s), 1, 4 * kEpsilon);
    EXPECT_NEAR(length(f.t), 1, 4 * kEpsilon);
    EXPECT_NEAR(dot(cross(f.s, f.t), f.n), 1, 8 * kEpsilon);
    const Vec3 v{Float(0.3), Float(-0.5), Float(0.8)};
    EXPECT_NEAR(length(f.to_world(f.to_local(v)) - v), 0, 8 * kEpsilon);
  }
}

TEST(Vec, TransformsComposeInnerFirst) {
  Transform scale, move;
  for (int i = 0; i < 3; ++i) scale.m[i][i] = 2;
  move.m[0][3] = 5;
  EXPECT_EQ(scale.compose(move).point({1, 1, 1}), (Vec3{12, 2, 2}));
  EXPECT_EQ(move.compose(scale).point({1, 1, 1}), (Vec3{7, 2, 2}));
  EXPECT_EQ(move.compose(scale).vector({1, 1, 1}), (Vec3{2, 2, 2}));
  EXPECT_EQ(scale.determinant(), 8);
}

TEST(Vec, NormalsStayPerpendicularUnderShear) {
  Transform shear;
  shear.m[0][1] = Float(0.7);
  shear.m[2][0] = Float(-0.4);
  shear.m[1][1] = 3;
  const Vec3 a{1, 2, 3}, b{-2, 1, Float(0.5)};
  const Vec3 n = shear.normal(cross(a, b));
  EXPECT_NEAR(dot(n, shear.vector(a)) / length(n), 0, 1e-5);  // 10x observed
  EXPECT_NEAR(dot(n, shear.vector(b)) / length(n), 0, 1e-5);
  EXPECT_NEAR(length(n - cross(shear.vector(a), shear.vector(b))), 0, 1e-4);
}

}  // namespace
}  // namespace spectrace
