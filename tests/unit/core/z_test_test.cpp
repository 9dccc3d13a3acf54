// SPDX-License-Identifier: Apache-2.0
#include "core/image/z_test.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "core/base/error.h"

namespace spectrace {
namespace {

Image image_of(int size, const std::function<float(std::size_t)>& value) {
  Image image(size, size, {"R", "G", "B"});
  for (std::size_t i = 0; i < image.data.size(); ++i) image.data[i] = value(i);
  return image;
}

/// Two images of one truth: means of Gaussian noise whose variance differs from value to value.
struct Noisy {
  Image reference, reference_variance, test, test_variance;

  /// `bias(i)`: added to value i of the test image, in standard deviations of its difference.
  Noisy(int size, unsigned seed, const std::function<double(std::size_t)>& bias) {
    std::mt19937 random(seed);
    std::normal_distribution<double> gauss;
    const auto truth = [](std::size_t i) { return 0.5 + 0.4 * std::sin(0.1 * double(i)); };
    const auto sigma_r = [](std::size_t i) { return 0.01 * (1 + double(i % 7)); };
    const auto sigma_t = [](std::size_t i) { return 0.05 * (1 + double(i % 5)); };
    reference = image_of(size, [&](std::size_t i) { return float(truth(i) + sigma_r(i) * gauss(random)); });
    reference_variance = image_of(size, [&](std::size_t i) { return float(sigma_r(i) * sigma_r(i)); });
    test = image_of(size, [&](std::size_t i) {
      return float(truth(i) + sigma_t(i) * gauss(random) + bias(i) * std::hypot(sigma_r(i), sigma_t(i)));
    });
    test_variance = image_of(size, [&](std::size_t i) { return float(sigma_t(i) * sigma_t(i)); });
  }
  [[nodiscard]] ZTestResult result(const ZTestOptions& options = {}) const {
    return z_test(reference, reference_variance, test, test_variance, reference.data.size(), options);
  }
};
double unbiased(std::size_t) { return 0; }

TEST(ZThreshold, IsTheTwoSidedQuantile) {
  // Quantiles of the standard normal distribution: 97.5 %, 99.5 %; scipy 1.17, norm.isf(p / 2).
  EXPECT_NEAR(z_threshold(0.05, 1), 1.959963984540054, 1e-12);
  EXPECT_NEAR(z_threshold(0.01, 1), 2.575829303548901, 1e-12);
  // p = 1 - 0.99^(1/n): 48 x 48 and 1920 x 1080 pixels of three channels.
  EXPECT_NEAR(z_threshold(0.01, 6912), 4.8174506211163965, 1e-12);
  EXPECT_NEAR(z_threshold(0.01, 6220800), 6.032382127419932, 1e-12);
}

// Šidák: of images that estimate the same, the share alpha has any rejection at all, in either direction.
// 400 images at alpha 0.5: 200 expected, standard deviation 10; at alpha 0.01 4, at most 15 with probability
// 1 - 1e-5. Bounds of 4.4 standard deviations: significance 1e-5 each.
TEST(ZTest, RejectsEqualImagesAtItsLevel) {
  constexpr int kImages = 400;
  int half = 0, hundredth = 0;
  for (unsigned seed = 0; seed < kImages; ++seed) {
    const Noisy noisy(16, seed, unbiased);
    half += noisy.result({.alpha = 0.5}).accepted_share < 1 ? 1 : 0;
    hundredth += noisy.result({.alpha = 0.01}).accepted_share < 1 ? 1 : 0;
  }
  EXPECT_GT(half, 156);
  EXPECT_LT(half, 244);
  EXPECT_LE(hundredth, 15);
}

// 48 x 48 x 3 tests: |z| <= 4.82. A bias of d is found in a channel with probability Phi(d - 4.82), hence in
// 0.74 % of the pixels at d = 2 (0.25 % suffice), in 0.02 % at d = 1.
TEST(ZTest, FindsABiasOfTwoStandardDeviations) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    for (const double sign : {-1.0, 1.0}) {
      EXPECT_FALSE(Noisy(48, seed, [&](std::size_t) { return 2 * sign; }).result().passes) << seed;
      EXPECT_TRUE(Noisy(48, seed, [&](std::size_t) { return sign; }).result().passes) << seed;
    }
    EXPECT_TRUE(Noisy(48, seed, unbiased).result().passes) << seed;
  }
}

TEST(ZTest, FindsAWrongPatchOfFourHundredthsOfAPercentMoreThanMayBe) {
  // 2304 pixels: 5 may reject (0.217 %), 6 may not (0.26 %).
  const auto in_patch = [](std::size_t pixels) {
    return [=](std::size_t i) { return i / 3 < pixels ? 20.0 : 0.0; };
  };
  EXPECT_TRUE(Noisy(48, 1, in_patch(5)).result().passes);
  EXPECT_FALSE(Noisy(48, 1, in_patch(6)).result().passes);
  // One channel is enough.
  EXPECT_FALSE(
      Noisy(48, 1, [](std::size_t i) { return i / 3 < 6 && i % 3 == 1 ? 20.0 : 0.0; }).result().passes);
}

TEST(ZTest, OfTheMeansFindsWhatEveryPixelHides) {
  // 0.15 standard deviations, less than any pixel can show, are 7 standard errors of 2304 pixels.
  const auto small = [](std::size_t) { return 0.15; };
  for (unsigned seed = 0; seed < 5; ++seed) {
    EXPECT_TRUE(Noisy(48, seed, small).result().passes) << "not judged unless asked for";
    EXPECT_FALSE(Noisy(48, seed, small).result({.mean_z = 4}).passes);
    EXPECT_TRUE(Noisy(48, seed, unbiased).result({.mean_z = 4}).passes);
  }
}

TEST(ZTest, WithoutVarianceAllowsRoundOffAlone) {
  const Image flat = image_of(16, [](std::size_t) { return 0.7f; });
  const Image none = image_of(16, [](std::size_t) { return 0.0f; });
  const auto result = [&](const Image& r, float value) {
    return z_test(r, none, image_of(16, [&](std::size_t) { return value; }), Image(), r.data.size());
  };
  EXPECT_EQ(result(flat, 0.7f).largest_z, 0);
  EXPECT_TRUE(result(flat, 0.7f * (1 + 2e-6f)).passes) << "two standard deviations of round-off";
  EXPECT_FALSE(result(flat, 0.7f * (1 + 2e-5f)).passes);
  EXPECT_TRUE(result(none, 0).passes) << "black stays black";
  EXPECT_FALSE(result(none, 1e-6f).passes) << "any light where there was none";
  EXPECT_FALSE(result(none, -1e-6f).passes);
}

TEST(ZTest, TellsWhereItIsWorst) {
  Noisy noisy(16, 3, unbiased);
  noisy.test.at(5, 9, 1) += 3;
  const ZTestResult result = noisy.result();
  EXPECT_EQ(result.x, 5);
  EXPECT_EQ(result.y, 9);
  EXPECT_EQ(result.accepted_share, 255.0 / 256);
  EXPECT_GT(result.z.at(5, 9, 1), result.threshold);
}

TEST(ZTest, RejectsWhatIsNotFinite) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN(),
                  kInf = std::numeric_limits<float>::infinity();
  for (const float bad : {kNan, kInf}) {
    for (Image Noisy::*where : {&Noisy::reference, &Noisy::test, &Noisy::reference_variance}) {
      Noisy noisy(16, 3, unbiased);
      (noisy.*where).at(1, 2, 0) = bad;
      const bool hides = where == &Noisy::reference_variance && bad == kInf;  // every value accepts
      EXPECT_EQ(noisy.result().accepted_share, hides ? 1 : 255.0 / 256);
      EXPECT_EQ(std::isinf(noisy.result().largest_z), !hides);
    }
  }
}

TEST(ZTest, ChecksItsImages) {
  const Noisy noisy(16, 0, unbiased);
  EXPECT_THROW(static_cast<void>(z_test(noisy.reference, Image(), noisy.test, Image(), 1 << 20)),
               InternalError);
  EXPECT_THROW(static_cast<void>(z_test(noisy.reference, noisy.reference_variance, noisy.test, Image(), 1)),
               InternalError);
}

}  // namespace
}  // namespace spectrace
