// SPDX-License-Identifier: Apache-2.0
#include "materials/half_difference.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/math/math.h"

namespace spectrace {
namespace {

// Directions are single precision: an angle is known to a few of its roundings (6e-8), an azimuth to those
// divided by the sine of its polar angle, here at least 0.05.
constexpr double kAngleTolerance = 5e-7, kAzimuthTolerance = 1e-5;

Vec3 direction(double theta, double phi) {
  return {Float(std::sin(theta) * std::cos(phi)), Float(std::sin(theta) * std::sin(phi)),
          Float(std::cos(theta))};
}

TEST(HalfDifference, RoundTripsThroughDirections) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < 20000; ++i) {
    const HalfDifference a{.theta_h = 0.05 + 1.45 * unit(random),
                           .theta_d = 0.05 + 1.45 * unit(random),
                           .phi_d = 0.001 + (kPi64 - 0.002) * unit(random)};
    const DirectionPair pair = from_half_difference(a);
    const HalfDifference b = to_half_difference(pair.wo, pair.wi);
    EXPECT_NEAR(b.theta_h, a.theta_h, kAzimuthTolerance);  // the half vector shortens by cos theta_d
    EXPECT_NEAR(b.theta_d, a.theta_d, kAngleTolerance);
    EXPECT_NEAR(b.phi_d, a.phi_d, kAzimuthTolerance);
    EXPECT_NEAR(double(pair.wo.z) + pair.wi.z, 2 * std::cos(a.theta_h) * std::cos(a.theta_d),
                kAngleTolerance);
  }
}

TEST(HalfDifference, IgnoresSwapAndRotation) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < 5000; ++i) {
    const double to = 1.5 * unit(random), ti = 1.5 * unit(random), phi = 0.1 + 2.9 * unit(random);
    const double turn = 6 * unit(random);
    const HalfDifference a = to_half_difference(direction(to, 0), direction(ti, phi));
    const HalfDifference swapped = to_half_difference(direction(ti, phi), direction(to, 0));
    const HalfDifference turned = to_half_difference(direction(to, turn), direction(ti, phi + turn));
    EXPECT_NE(a.is_swapped, swapped.is_swapped);
    EXPECT_EQ(a.theta_h, swapped.theta_h);
    EXPECT_EQ(a.theta_d, swapped.theta_d);
    EXPECT_NEAR(std::remainder(a.phi_d - swapped.phi_d, kPi64), 0, 1e-12);
    EXPECT_NEAR(a.theta_h, turned.theta_h, kAngleTolerance);
    EXPECT_NEAR(a.theta_d, turned.theta_d, kAngleTolerance);
    if (a.theta_h > 0.05 && a.theta_d > 0.05) {
      EXPECT_NEAR(std::remainder(a.phi_d - turned.phi_d, kPi64), 0, kAzimuthTolerance);
    }
    for (const HalfDifference& each : {a, swapped, turned}) {
      EXPECT_GE(each.phi_d, 0);
      EXPECT_LT(each.phi_d, kPi64);
    }
  }
}

TEST(HalfDifference, IsDefinedWhereAzimuthsAreNot) {
  const HalfDifference normal = to_half_difference({0, 0, 1}, {0, 0, 1});
  EXPECT_EQ(normal.theta_h, 0);
  EXPECT_EQ(normal.theta_d, 0);
  EXPECT_EQ(normal.phi_d, 0);
  const HalfDifference retro = to_half_difference({Float(0.6), 0, Float(0.8)}, {Float(0.6), 0, Float(0.8)});
  EXPECT_NEAR(retro.theta_h, std::atan2(0.6, 0.8), kAngleTolerance);
  EXPECT_EQ(retro.theta_d, 0);
  EXPECT_EQ(retro.phi_d, 0);
  const HalfDifference mirror = to_half_difference({Float(0.6), 0, Float(0.8)}, {Float(-0.6), 0, Float(0.8)});
  EXPECT_EQ(mirror.theta_h, 0);
  EXPECT_NEAR(mirror.theta_d, std::atan2(0.6, 0.8), kAngleTolerance);
  EXPECT_EQ(mirror.phi_d, 0);
  const HalfDifference opposite = to_half_difference({1, 0, 0}, {-1, 0, 0});
  EXPECT_EQ(opposite.theta_h, 0);
  EXPECT_EQ(opposite.theta_d, kPi64 / 2);
  EXPECT_EQ(opposite.phi_d, 0);
}

TEST(HalfDifference, GeometryIsThatOfTheVectors) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < 5000; ++i) {
    const double theta_o = 0.05 + 1.5 * unit(random), theta_i = 0.05 + 1.5 * unit(random);
    const double phi_o = 6 * unit(random), phi_i = 6 * unit(random);
    const Vec3 wo = direction(theta_o, phi_o), wi = direction(theta_i, phi_i);
    const PairGeometry pair = geometry_of(wo, wi);
    const Vec3 h = normalize(wo + wi);
    EXPECT_NEAR(pair.theta_o, theta_o, kAngleTolerance);
    EXPECT_EQ(pair.theta_o, theta_of(wo));
    EXPECT_NEAR(pair.cos_d, std::cos(pair.angles.theta_d), kAngleTolerance);
    EXPECT_NEAR(pair.z_h, 1 - std::cos(pair.angles.theta_h), kAngleTolerance);
    if (pair.angles.theta_h < 0.05) continue;  // the azimuth of h is not known well
    const double phi = std::abs(std::remainder(std::atan2(double(h.y), double(h.x)) - phi_o, 2 * kPi64));
    EXPECT_NEAR(pair.phi_h, phi, kAzimuthTolerance);
  }
}

}  // namespace
}  // namespace spectrace
