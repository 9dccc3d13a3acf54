// SPDX-License-Identifier: Apache-2.0
#include "materials/separated_brdf.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "core/math/math.h"
#include "tests/support/chi_square.h"
#include "tests/support/synthetic_separated.h"

namespace spectrace {
namespace {

constexpr std::array kModels{SeparationModel::kSun, SeparationModel::kFresnel, SeparationModel::kDiffraction};

SampledWavelengths some_wavelengths() {
  std::array<Float, kLanes> lambda_nm{}, pdf{};
  for (int i = 0; i < kLanes; ++i) lambda_nm[i] = 420 + 300 * Float(i) / kLanes;
  pdf.fill(Float(1) / 470);
  return {lambda_nm, pdf};
}
const SampledWavelengths kLambda = some_wavelengths();
const ShadingPoint kPoint{.lambda = kLambda};

Vec3 direction(double theta_deg, double phi_deg) {
  const double theta = theta_deg * kPi64 / 180, phi = phi_deg * kPi64 / 180;
  return {Float(std::sin(theta) * std::cos(phi)), Float(std::sin(theta) * std::sin(phi)),
          Float(std::cos(theta))};
}

Vec3 random_direction(test::TestRandom& random) {
  return direction(89.9 * double(random.uniform()), 360 * double(random.uniform()));
}

TEST(SeparatedBrdf, IsTheSumOfEq5And6) {
  const auto tables = test::synthetic_separated();
  const SeparatedBrdf brdf(tables, SeparationModel::kFresnel);
  const HalfDifferenceGrid& grid = tables->grid;
  // At a node nothing is interpolated; the wavelength is a tabulated one.
  const HalfDifference node{grid.theta_h(20), grid.theta_d(30), grid.phi_d(50)};
  const DirectionPair pair = from_half_difference(node);
  std::array<Float, kLanes> lambda_nm{}, pdf{};
  lambda_nm.fill(550);
  pdf.fill(1);
  const SampledWavelengths lambda(lambda_nm, pdf);
  const double rho_s =
      double(tables->rho_s[grid.index(20, 30, 50)]) / (2 * std::cos(node.theta_h) * std::cos(node.theta_d));
  const double expected =
      (double(tables->c_d[3]) / kPi64 + rho_s * double(tables->s_fresnel[30 * tables->axis.size() + 3])) *
      double(pair.wi.z);
  // Float angles: 1e-7 of a coordinate times the slope of the table.
  EXPECT_NEAR(double(brdf.evaluate(pair.wo, pair.wi, {.lambda = lambda}).value_cos[0]) / expected, 1, 1e-4);
}

TEST(SeparatedBrdf, IsReciprocal) {
  test::TestRandom random(5);
  for (SeparationModel model : kModels) {
    const SeparatedBrdf brdf(test::synthetic_separated(), model);
    for (int i = 0; i < 2000; ++i) {
      const Vec3 wo = random_direction(random), wi = random_direction(random);
      const SampledSpectrum there = brdf.evaluate(wo, wi, kPoint).value_cos / wi.z;
      const SampledSpectrum back = brdf.evaluate(wi, wo, kPoint).value_cos / wo.z;
      for (int k = 0; k < kLanes; ++k) ASSERT_NEAR(there[k] / back[k], 1, 1e-4) << name_of(model);
    }
  }
}

TEST(SeparatedBrdf, LobesSumToEvaluate) {
  test::TestRandom random(6);
  for (SeparationModel model : kModels) {
    const SeparatedBrdf brdf(test::synthetic_separated(), model);
    for (int i = 0; i < 2000; ++i) {
      const Vec3 wo = random_direction(random), wi = random_direction(random);
      const SampledSpectrum value = brdf.evaluate(wo, wi, kPoint).value_cos;
      const LobeValues lobes = brdf.evaluate_lobes(wo, wi, kPoint);
      for (int k = 0; k < kLanes; ++k) {
        ASSERT_NEAR(lobes.total()[k], value[k], 1e-5 * value[k]);
        ASSERT_GE(lobes.diffuse[k], 0);
        ASSERT_GE(lobes.fresnel[k], 0);
        if (model != SeparationModel::kDiffraction) {
          ASSERT_EQ(lobes.diffraction[k], 0);
        }
      }
    }
  }
}

TEST(SeparatedBrdf, TheDiffractionEffectIsTheDifferenceOfTwoModels) {
  const auto tables = test::synthetic_separated();
  const SeparatedBrdf diffraction(tables, SeparationModel::kDiffraction),
      fresnel(tables, SeparationModel::kFresnel);
  const Vec3 wo = direction(30, 0), wi = direction(50, 150);
  const SampledSpectrum expected =
      diffraction.evaluate(wo, wi, kPoint).value_cos - fresnel.evaluate(wo, wi, kPoint).value_cos;
  const LobeValues lobes = diffraction.evaluate_lobes(wo, wi, kPoint);
  bool some_negative = false;
  for (int k = 0; k < kLanes; ++k) {
    EXPECT_NEAR(lobes.diffraction[k], expected[k], 1e-6);
    some_negative = some_negative || lobes.diffraction[k] < 0;
  }
  EXPECT_TRUE(some_negative);  // signed, as eq. 21 is
}

TEST(SeparatedBrdf, SamplesCarryTheValueAndDensityOfEvaluate) {
  test::TestRandom random(8);
  for (SeparationModel model : kModels) {
    const SeparatedBrdf brdf(test::synthetic_separated({.alpha = 0.05}), model);
    for (double theta : {0.0, 60.0, 79.0, 85.0, 89.9}) {
      const Vec3 wo = direction(theta, 20);
      for (int i = 0; i < 1000; ++i) {
        const auto sample =
            brdf.sample(wo, {.lobe = random.uniform(), .direction = random.uniform2()}, kPoint);
        if (!sample) continue;
        const BsdfValue value = brdf.evaluate(wo, sample->wi, kPoint);
        ASSERT_GT(sample->pdf, 0);
        ASSERT_EQ(sample->pdf, value.pdf);
        ASSERT_GT(sample->wi.z, 0);
        for (int k = 0; k < kLanes; ++k) ASSERT_NEAR(sample->weight[k] * value.pdf, value.value_cos[k], 1e-5);
      }
    }
  }
}

TEST(SeparatedBrdf, SamplesFollowTheDensity) {
  // Both angles and both extremes of roughness; 1 % over all trials together.
  const std::array<double, 5> thetas{0, 60, 79, 85, 89.9};
  const std::array<double, 2> alphas{0.02, 0.4};
  const double level = test::sidak_level(0.01, 2 * thetas.size() * alphas.size());
  for (double alpha : alphas) {
    const SeparatedBrdf brdf(test::synthetic_separated({.albedo_d = 0, .alpha = alpha}),
                             SeparationModel::kDiffraction);
    for (double theta : thetas) {
      const Vec3 wo = direction(theta, 30);
      const auto result = test::test_sampling(
          [&](test::TestRandom& random) -> std::optional<Vec3> {
            const Float lobe = random.uniform();
            const auto sample = brdf.sample(wo, {.lobe = lobe, .direction = random.uniform2()}, kPoint);
            if (!sample) return std::nullopt;
            return sample->wi;
          },
          [&](Vec3 wi) { return double(brdf.evaluate(wo, wi, kPoint).pdf); },
          {.samples = 200'000, .azimuth_zero = {-wo.x, -wo.y, 0}});
      EXPECT_GT(result.p_value, level) << "theta " << theta << " alpha " << alpha << ": " << result.text();
      EXPECT_GT(result.p_value_kept, level)
          << "theta " << theta << " alpha " << alpha << ": " << result.text();
      EXPECT_EQ(result.below_horizon, 0U);
    }
  }
}

TEST(SeparatedBrdf, WeightsAreNeverLargerThanAFewTimesTheAlbedo) {
  test::TestRandom random(9);
  // Sampling proportional to the lobe gives weights near the albedo; what interpolation and the cosine share
  // add is bounded. 12 is twice the largest seen over these 400,000 samples.
  constexpr Float kLargestWeight = 12;
  for (double alpha : {0.01, 0.1, 0.5}) {
    const SeparatedBrdf brdf(test::synthetic_separated({.albedo_d = 0, .rho_0 = 1, .alpha = alpha}),
                             SeparationModel::kDiffraction);
    for (double theta : {0.0, 45.0, 79.0, 89.9}) {
      const Vec3 wo = direction(theta, 70);
      for (int i = 0; i < 30'000; ++i) {
        const auto sample =
            brdf.sample(wo, {.lobe = random.uniform(), .direction = random.uniform2()}, kPoint);
        if (!sample) continue;
        ASSERT_LT(sample->weight.max(), kLargestWeight) << "theta " << theta << " alpha " << alpha;
      }
    }
  }
}

TEST(SeparatedBrdf, DegenerateDirectionsGiveNothing) {
  const SeparatedBrdf brdf(test::synthetic_separated(), SeparationModel::kDiffraction);
  const Vec3 up{0, 0, 1}, wo = direction(40, 10);
  for (const auto& [o, i] :
       std::array<std::pair<Vec3, Vec3>, 4>{{{wo, -wo}, {up, -up}, {{1, 0, 0}, up}, {up, Vec3{1, 0, 0}}}}) {
    const BsdfValue value = brdf.evaluate(o, i, kPoint);
    EXPECT_TRUE(value.value_cos.is_zero());
    EXPECT_EQ(value.pdf, 0);
    EXPECT_TRUE(brdf.evaluate_lobes(o, i, kPoint).total().is_zero());
  }
  EXPECT_FALSE(brdf.sample({1, 0, 0}, {}, kPoint).has_value());
  EXPECT_FALSE(brdf.sample(-up, {}, kPoint).has_value());
}

TEST(SeparatedBrdf, GrazingValuesAreBoundedByTheTable) {
  const auto tables = test::synthetic_separated({.albedo_d = 0});
  const SeparatedBrdf brdf(tables, SeparationModel::kDiffraction);
  const Float bound = *std::max_element(tables->rho_s.begin(), tables->rho_s.end()) *
                      *std::max_element(tables->s_diffraction.begin(), tables->s_diffraction.end());
  for (double theta_o : {0.0, 60.0, 89.0, 89.9, 89.99, 89.9999}) {
    for (double theta_i : {0.0, 60.0, 89.0, 89.99, 89.9999}) {
      for (double phi : {0.0, 90.0, 179.0, 180.0}) {
        const BsdfValue value = brdf.evaluate(direction(theta_o, 0), direction(theta_i, phi), kPoint);
        EXPECT_TRUE(value.value_cos.is_finite());
        EXPECT_TRUE(std::isfinite(value.pdf));
        EXPECT_LE(value.value_cos.max(), bound);
      }
    }
  }
}

TEST(SeparatedBrdf, AtTheMirrorDirectionAzimuthMeansNothing) {
  const SeparatedBrdf brdf(test::synthetic_separated(), SeparationModel::kDiffraction);
  const Float reference = brdf.evaluate(direction(35, 0), direction(35, 180), kPoint).value_cos[0];
  for (double phi = 0; phi < 360; phi += 7) {
    const Vec3 wo = direction(35, phi), wi = direction(35, phi + 180);
    EXPECT_NEAR(brdf.evaluate(wo, wi, kPoint).value_cos[0] / reference, 1, 1e-5);
    // Continuous: a nudge of 1e-5 rad moves the value by its slope times that.
    const Vec3 nudged = normalize(wi + Vec3{Float(1e-5), 0, 0});
    EXPECT_NEAR(brdf.evaluate(wo, nudged, kPoint).value_cos[0] / reference, 1, 1e-4);
  }
}

TEST(SeparatedBrdf, ExtremeRandomNumbersGiveValidSamplesOrNone) {
  for (SeparationModel model : kModels) {
    const SeparatedBrdf brdf(test::synthetic_separated(), model);
    const std::array<Float, 4> extremes{0, Float(0.5), kOneMinusEpsilon, 1};
    for (double theta : {0.0, 45.0, 89.9}) {
      for (Float a : extremes) {
        for (Float b : extremes) {
          for (Float c : extremes) {
            const auto sample = brdf.sample(direction(theta, 0), {.lobe = a, .direction = {b, c}}, kPoint);
            if (!sample) continue;
            EXPECT_GT(sample->pdf, 0);
            EXPECT_TRUE(sample->weight.is_finite());
            EXPECT_NEAR(length(sample->wi), 1, 1e-5);
          }
        }
      }
    }
  }
}

TEST(SeparatedBrdf, AnEmptyLobeIsExactlyZeroAndNeverSampled) {
  test::TestRandom random(4);
  const SeparatedBrdf diffuse(test::synthetic_separated({.rho_0 = 0}), SeparationModel::kDiffraction);
  const SeparatedBrdf specular(test::synthetic_separated({.albedo_d = 0}), SeparationModel::kDiffraction);
  const SeparatedBrdf nothing(test::synthetic_separated({.albedo_d = 0, .rho_0 = 0}),
                              SeparationModel::kDiffraction);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 wo = random_direction(random), wi = random_direction(random);
    const BsdfRandom u{.lobe = i == 0 ? 1 : random.uniform(), .direction = random.uniform2()};
    EXPECT_TRUE(diffuse.evaluate_lobes(wo, wi, kPoint).specular().is_zero());
    EXPECT_TRUE(specular.evaluate_lobes(wo, wi, kPoint).diffuse.is_zero());
    if (const auto sample = diffuse.sample(wo, u, kPoint)) {
      EXPECT_EQ(sample->lobe, Lobe::kDiffuse);
      EXPECT_NEAR(sample->pdf, sample->wi.z * kInvPi, 1e-6);
    }
    if (const auto sample = specular.sample(wo, u, kPoint)) {
      EXPECT_EQ(sample->lobe, Lobe::kSpecular);
    }
    EXPECT_FALSE(nothing.sample(wo, u, kPoint).has_value());
    EXPECT_EQ(nothing.evaluate(wo, wi, kPoint).pdf, 0);
  }
}

}  // namespace
}  // namespace spectrace
