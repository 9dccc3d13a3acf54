// SPDX-License-Identifier: Apache-2.0
#include "core/image/error_model.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "core/base/error.h"

namespace spectrace::test {
namespace {

/// As measured without any scatter.
std::vector<ErrorPoint> points_of(const ErrorModel& truth, double reference) {
  std::vector<ErrorPoint> points;
  for (const double n : {4.0, 8.0, 16.0, 32.0, 64.0})
    points.push_back({n, truth.seconds(n), truth.rel_mse(n) + reference});
  return points;
}

TEST(ErrorModel, NoiseAndTimeAreFoundAgain) {
  const ErrorModel truth{.noise = 0.3, .exponent = 1.3, .bias = 2e-3, .start = 0.5, .per_sample = 0.1};
  const ErrorModel found = fit_error_model(points_of(truth, 1e-4), truth.bias, 1e-4);
  EXPECT_NEAR(found.noise, truth.noise, 1e-9);
  EXPECT_NEAR(found.exponent, truth.exponent, 1e-9);
  EXPECT_EQ(found.bias, truth.bias);
  EXPECT_NEAR(found.start, truth.start, 1e-9);
  EXPECT_NEAR(found.per_sample, truth.per_sample, 1e-9);
}

TEST(ErrorModel, ScatterMakesNothingNegative) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> factor(0.8, 1.25);
  const ErrorModel truth{.noise = 0.3, .exponent = 1.3, .bias = 0, .start = 0, .per_sample = 0.1};
  for (int i = 0; i < 200; ++i) {
    std::vector<ErrorPoint> points = points_of(truth, 0);
    for (ErrorPoint& point : points) {
      point.rel_mse *= factor(random);
      point.seconds *= factor(random);
    }
    const ErrorModel found = fit_error_model(points, -1e-5, 0);
    EXPECT_EQ(found.bias, 0);
    EXPECT_GE(found.start, 0);
    // Five points scatter by a factor of at most 1.25 each way: what is between them does not scatter more.
    EXPECT_NEAR(found.rel_mse(16) / truth.rel_mse(16), 1, 0.25);
    EXPECT_NEAR(found.seconds(16) / truth.seconds(16), 1, 0.25);
  }
}

TEST(ErrorModel, SamplesForAnErrorAreThoseThatHaveIt) {
  const ErrorModel model{.noise = 0.3, .exponent = 1.3, .bias = 2e-3, .start = 0.5, .per_sample = 0.1};
  const std::optional<double> samples = model.samples_for(5e-3);
  ASSERT_TRUE(samples);
  EXPECT_NEAR(model.rel_mse(*samples), 5e-3, 1e-12);
  EXPECT_FALSE(model.samples_for(2e-3));
  EXPECT_EQ(model.samples_for(10).value(), 1);
}

TEST(ErrorModel, WhatIsNothingButBiasHasNoNoise) {
  const ErrorModel found = fit_error_model(points_of({.per_sample = 0.1}, 1e-3), 2e-3, 0);
  EXPECT_EQ(found.noise, 0);
  EXPECT_EQ(found.rel_mse(100), 2e-3);
}

TEST(ErrorModel, OnePointTellsNothing) {
  const std::vector<ErrorPoint> one{{4, 1, 0.1}}, same{{4, 1, 0.1}, {4, 1, 0.2}};
  EXPECT_THROW((void)fit_error_model(one, 0, 0), InternalError);
  EXPECT_THROW((void)fit_error_model(same, 0, 0), InternalError);
}

/// `value` everywhere, with noise of that standard deviation.
Image noisy(double value, double sigma, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0, sigma);
  Image image(100, 100, {"R", "G", "B"});
  for (float& x : image.data) x = static_cast<float>(value + noise(random));
  return image;
}

TEST(ErrorParts, BiasIsToldFromNoiseTenTimesAsLarge) {
  const Image r1 = noisy(2, 0.05, 1), r2 = noisy(2, 0.05, 2);
  for (const double bias : {0.0, 0.02, 0.1}) {
    const Image a = noisy(2 + bias, 0.2, 3), b = noisy(2 + bias, 0.2, 4);
    const Estimate found = bias_rel_mse({a, b}, {r1, r2}, 0);
    // Significance 6e-5 each: 4 standard errors.
    EXPECT_NEAR(found.value, bias * bias / 4, 4 * found.standard_error) << bias;
    EXPECT_LT(found.standard_error, 0.2 * 0.2 / 4 / 100) << "what noise alone would give, over root of n";
  }
}

TEST(ErrorParts, ThePairsMeanHasHalfTheVariance) {
  const Image r1 = noisy(2, 0.05, 1), r2 = noisy(2, 0.05, 2);
  const Estimate found = noise_rel_mse({r1, r2}, 0);
  EXPECT_NEAR(found.value, 0.05 * 0.05 / 2 / 4, 4 * found.standard_error);
}

TEST(ErrorParts, ImagesOfOtherSizesAreRefused) {
  const Image a = noisy(1, 0, 1), b(10, 10, {"R", "G", "B"});
  EXPECT_THROW((void)bias_rel_mse({a, a}, {a, b}, 0), InternalError);
}

}  // namespace
}  // namespace spectrace::test
