// SPDX-License-Identifier: Apache-2.0
// H4, H5: the half vector is zero, lies in the horizon, or is the normal and has no azimuth. That every BSDF
// is finite there is EveryBsdfContract's.
#include <gtest/gtest.h>

#include <cmath>

#include "core/math/math.h"
#include "tests/hard_cases/every_measurement.h"
#include "tests/support/chi_square.h"
#include "tests/support/shading_point.h"

namespace spectrace::test {
namespace {

using H04_ZeroHalfVector = EveryMeasurement;

TEST_P(H04_ZeroHalfVector, OppositeDirectionsReflectNothing) {
  for (const auto& [name, material] : forms()) {
    for (const double theta : {0.0, 30.0, 89.0, 89.999999, 90.0}) {
      const Vec3 wo = direction_deg(theta, 70);
      EXPECT_TRUE(is_nothing(evaluate(material, wo, -wo, kAt))) << name << ' ' << theta;
      EXPECT_TRUE(is_nothing(evaluate(material, -wo, wo, kAt))) << name << ' ' << theta;
      EXPECT_TRUE(evaluate_lobes(material, wo, -wo, kAt).total().is_zero()) << name << ' ' << theta;
    }
    // In the horizon, where the half vector of opposite directions is the difference of rounding errors.
    const Vec3 level{1, 0, Float(1e-30)}, opposite{-1, 0, Float(1e-30)};
    EXPECT_TRUE(is_valid(evaluate(material, level, opposite, kAt))) << name;
    EXPECT_TRUE(is_valid(evaluate(material, level, level, kAt))) << name << ": theta_h = 90 degrees";
  }
}

TEST(H04_ZeroHalfVector, RoughGlassOfLeastContrastLetsLightThrough) {
  // Refracted light has the half vector wo + eta wi, all but zero here where all light goes.
  for (const Float eta : {1 + kMinRoughContrast, 1 - kMinRoughContrast}) {
    const Material glass = RoughDielectric(Spectrum::constant(eta), {Float(0.1), Float(0.1)});
    for (const double theta : {0.0, 45.0, 89.99}) {
      for (const int side : {1, -1}) {
        SCOPED_TRACE(testing::Message() << "eta " << eta << ", " << theta << " degrees, side " << side);
        const Vec3 wo = direction_deg(theta, 20) * Float(side);
        EXPECT_TRUE(is_valid(evaluate(glass, wo, -wo, kAt)));
        TestRandom random(3);
        double sum = 0;
        constexpr int kSamples = 4000;
        for (int i = 0; i < kSamples; ++i) {
          const Float lobe = random.uniform();
          const auto s = sample(glass, wo, {lobe, random.uniform2()}, kAt);
          if (!s) continue;
          ASSERT_TRUE(is_finite(s->wi) && s->pdf > 0 && std::isfinite(s->pdf) && is_valid(s->weight));
          sum += double(s->weight[0] / s->radiance_scale);
        }
        // Facets keep each other's light at grazing; of alpha 0.1 next to nothing up to 45 degrees.
        if (theta <= 45) {
          EXPECT_NEAR(sum / kSamples, 1, 0.01);
        }
      }
    }
  }
}

using H05_HalfVectorAtTheNormal = EveryMeasurement;

/// f, of the half vector at the normal, its place and the pair's azimuth told apart.
double mirrored(const Material& material, double theta_deg, double phi_deg) {
  const Vec3 wo = direction_deg(theta_deg, phi_deg);
  return double(evaluate(material, wo, {-wo.x, -wo.y, wo.z}, kAt).value_cos[1]);
}

constexpr double kContinuity = 1e-5;  // what the case asks for

TEST_P(H05_HalfVectorAtTheNormal, ItsAzimuthMeansNothing) {
  for (const auto& [name, material] : forms()) {
    if (!measured().tables().is_isotropic()) continue;  // which does turn with wo
    for (const double theta : {0.0, 20.0, 60.0, 75.0}) {
      const double first = mirrored(material, theta, 0);
      for (double phi = 7; phi < 360; phi += 7) {
        EXPECT_NEAR(mirrored(material, theta, phi), first, kContinuity * first) << name << ' ' << theta;
      }
    }
  }
}

TEST_P(H05_HalfVectorAtTheNormal, SeparatedTablesAreContinuousThere) {
  if (!separated()) GTEST_SKIP() << "anisotropic: not separated";
  const HalfDifferenceGrid& grid = separated()->grid;
  const auto rho_s = [&](const HalfDifference& angles) {
    const GridPoint at = grid.locate(angles);
    double sum = 0;
    for (std::size_t i = 0; i < at.cell.size(); ++i) {
      sum += double(at.cell_weight[i]) * double(separated()->rho_s[at.cell[i]]);
    }
    return sum;
  };
  for (double theta_d = 0; theta_d < 1.5; theta_d += 0.1) {
    const double pole = rho_s({0, theta_d, 0});
    for (double phi_d = 0; phi_d < kPi64; phi_d += 0.1) {
      EXPECT_NEAR(rho_s({0, theta_d, phi_d}), pole, kContinuity * pole);
      // The table is linear in the root of theta_h: this is a millionth of its first cell.
      EXPECT_NEAR(rho_s({1e-15, theta_d, phi_d}), pole, kContinuity * pole) << theta_d << ' ' << phi_d;
    }
  }
}

TEST_P(H05_HalfVectorAtTheNormal, SeparatedMaterialsMakeNoStepThere) {
  if (!separated()) GTEST_SKIP() << "anisotropic: not separated";
  // To the next direction that single precision has, the root of theta_h takes two hundredths of the first
  // cell of this coarse grid: 2.8e-4 was seen.
  constexpr double kFirstStep = 6e-4;
  for (const auto& [name, material] : forms()) {
    if (name == "measured") continue;  // its nodes there were measured one by one, at all azimuths
    for (const double theta : {0.0, 20.0, 60.0, 75.0}) {
      const Vec3 wo = direction_deg(theta, 33), mirror{-wo.x, -wo.y, wo.z};
      const auto f = [&](Vec3 wi) { return double(evaluate(material, wo, wi, kAt).value_cos[1] / wi.z); };
      for (double phi = 0; phi < 360; phi += 15) {
        const Vec3 wi = normalize(mirror + direction_deg(90, phi) * Float(2e-7));
        EXPECT_NEAR(f(wi), f(mirror), kFirstStep * f(mirror)) << name << ' ' << theta << ' ' << phi;
      }
    }
  }
}

SPECTRACE_ON_EVERY_MEASUREMENT(H04_ZeroHalfVector);
SPECTRACE_ON_EVERY_MEASUREMENT(H05_HalfVectorAtTheNormal);

}  // namespace
}  // namespace spectrace::test
