// SPDX-License-Identifier: Apache-2.0
#include "core/image/metrics.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "core/base/error.h"

namespace spectrace {
namespace {

// Sums of some thousand doubles, in another order than numpy's.
constexpr double kRoundOff = 1e-11;
constexpr float kNotANumber = std::numeric_limits<float>::quiet_NaN();

/// Values are multiples of 1/64 and 1/32, so that every program has the very same input.
Image synthetic_reference() {
  Image image(32, 24, {"R", "G", "B"});
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      for (int c = 0; c < 3; ++c) {
        const int a = (x * 7 + y * 13 + c * 29) % 64, b = (x * x + 3 * y) % 17;
        image.at(x, y, c) = static_cast<float>(a) / 64 + static_cast<float>(b) / 32;
      }
    }
  }
  return image;
}

Image synthetic_test() {
  Image image = synthetic_reference();
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      for (int c = 0; c < 3; ++c) {
        image.at(x, y, c) += static_cast<float>((x * 5 + y * 11 + c * 3) % 32 - 16) / 256;
      }
    }
  }
  return image;
}

Image constant(float value) {
  Image image(16, 16, {"R", "G", "B"});
  image.data.assign(image.data.size(), value);
  return image;
}

// Reference values: scikit-image 0.26.0, structural_similarity(gaussian_weights=True, sigma=1.5,
// use_sample_covariance=False, channel_axis=2), peak_signal_noise_ratio, mean_squared_error; the others
// numpy.
TEST(Metrics, AgreeWithScikitImage) {
  const Metrics m = compare_images(synthetic_reference(), synthetic_test());
  EXPECT_TRUE(m.finite);
  EXPECT_EQ(m.data_range, 1.484375);
  EXPECT_NEAR(m.mse, 0.00130462646484375, kRoundOff);
  EXPECT_NEAR(m.psnr_db, 32.27601078505448, kRoundOff);
  EXPECT_NEAR(m.ssim, 0.9937770241745306, kRoundOff);
  EXPECT_NEAR(m.mae, 0.03125, kRoundOff);
  EXPECT_NEAR(m.rel_mse, 0.0066041517542506645, kRoundOff);
  EXPECT_NEAR(m.mape, 0.06394243447316766, kRoundOff);
  EXPECT_EQ(m.max_abs, 0.0625);

  const Metrics unit = compare_images(synthetic_reference(), synthetic_test(), {.data_range = 1});
  EXPECT_NEAR(unit.psnr_db, 28.845138158955265, kRoundOff);
  EXPECT_NEAR(unit.ssim, 0.9937431622530429, kRoundOff);
}

TEST(Metrics, OfChosenChannelsAreThoseOfThemAlone) {
  const Image r = synthetic_reference(), t = synthetic_test();
  const std::vector<std::size_t> in_reference{0, 2}, in_test{2, 0};
  const std::array<std::string, 2> first{"R", "B"}, second{"B", "R"};
  const ChannelMetrics m = compare_channels(r, in_reference, t, in_test);
  const Metrics alone = compare_images(r.select(first, "r"), t.select(second, "t"));
  EXPECT_EQ(m.together.mse, alone.mse);
  EXPECT_EQ(m.together.ssim, alone.ssim);
  ASSERT_EQ(m.each.size(), 2U);
  const Metrics one =
      compare_images(r.select(std::array<std::string, 1>{"B"}, "r"),
                     t.select(std::array<std::string, 1>{"R"}, "t"), {.data_range = alone.data_range});
  EXPECT_EQ(m.each[1].ssim, one.ssim);
  EXPECT_EQ(m.each[1].psnr_db, one.psnr_db);
  EXPECT_NEAR((m.each[0].rel_mse + m.each[1].rel_mse) / 2, m.together.rel_mse, kRoundOff);
  EXPECT_EQ(std::max(m.each[0].max_abs, m.each[1].max_abs), m.together.max_abs);
}

TEST(Metrics, AskOnlyTheChosenChannelsToBeFinite) {
  Image broken = synthetic_reference();
  broken.at(3, 3, 1) = kNotANumber;
  const std::vector<std::size_t> without{0, 2}, with{0, 1};
  EXPECT_TRUE(compare_channels(broken, without, broken, without).together.finite);
  const ChannelMetrics bad = compare_channels(broken, with, broken, with);
  EXPECT_FALSE(bad.together.finite);
  EXPECT_TRUE(std::isnan(bad.each.at(0).mse));
}

TEST(Metrics, OfConstantImagesAreTheFormulas) {
  const Metrics m =
      compare_images(constant(0.5f), constant(0.25f), {.data_range = 1, .epsilon = 0.75, .mape_floor = 0.5});
  EXPECT_DOUBLE_EQ(m.mse, 0.0625);
  EXPECT_DOUBLE_EQ(m.mae, 0.25);
  EXPECT_DOUBLE_EQ(m.rel_mse, 0.0625);
  EXPECT_DOUBLE_EQ(m.mape, 0.25);
  EXPECT_DOUBLE_EQ(m.psnr_db, 10 * std::log10(16));
  // Without variance only SSIM's luminance term is left: (2 r t + c1) / (r² + t² + c1), c1 = 0.01².
  EXPECT_NEAR(m.ssim, (0.25 + 1e-4) / (0.3125 + 1e-4), kRoundOff);
}

TEST(Metrics, OfEqualImagesAreZeroAndInfinity) {
  const Metrics m = compare_images(synthetic_reference(), synthetic_reference());
  EXPECT_EQ(m.mse, 0);
  EXPECT_EQ(m.rel_mse, 0);
  EXPECT_EQ(m.max_abs, 0);
  EXPECT_EQ(m.psnr_db, std::numeric_limits<double>::infinity());
  EXPECT_NEAR(m.ssim, 1, kRoundOff);
}

TEST(Metrics, OfOneNonFinitePixelAreNotFinite) {
  for (const float bad :
       {kNotANumber, std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity()}) {
    Image broken = synthetic_reference();
    broken.at(31, 23, 2) = bad;
    for (const bool in_reference : {false, true}) {
      const Metrics m =
          in_reference ? compare_images(broken, synthetic_test()) : compare_images(synthetic_test(), broken);
      EXPECT_FALSE(m.finite);
      EXPECT_TRUE(std::isnan(m.psnr_db) && std::isnan(m.ssim) && std::isnan(m.mse) && std::isnan(m.rel_mse));
    }
  }
  Image all_nan = synthetic_reference();
  all_nan.data.assign(all_nan.data.size(), kNotANumber);
  EXPECT_FALSE(compare_images(all_nan, all_nan).finite) << "equal NaN images are no success";
}

TEST(Metrics, OfBlackReferencesTakeDataRangeOne) {
  EXPECT_EQ(compare_images(constant(0), constant(0.5f)).data_range, 1);
}

TEST(Metrics, HaveNoSsimBelowTheWindow) {
  const Image small(10, 40, {"R"}), just(11, 11, {"R"});
  EXPECT_TRUE(std::isnan(compare_images(small, small).ssim));
  EXPECT_EQ(compare_images(just, just).ssim, 1);
}

TEST(Metrics, CheckTheSizes) {
  EXPECT_THROW(compare_images(Image(11, 12, {"R"}), Image(12, 11, {"R"})), InternalError);
  EXPECT_THROW(compare_images(Image(11, 11, {"R"}), Image(11, 11, {"R", "G"})), InternalError);
}

}  // namespace
}  // namespace spectrace
