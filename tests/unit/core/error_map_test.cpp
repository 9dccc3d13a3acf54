// SPDX-License-Identifier: Apache-2.0
#include "core/image/error_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace spectrace {
namespace {

Image flat(float r, float g, float b) {
  Image image(4, 2, {"R", "G", "B"});
  for (std::size_t i = 0; i < image.data.size(); i += 3) {
    image.data[i] = r;
    image.data[i + 1] = g;
    image.data[i + 2] = b;
  }
  return image;
}

float luminance(const Image& image) {
  return 0.2126F * image.data[0] + 0.7152F * image.data[1] + 0.0722F * image.data[2];
}

TEST(ErrorMap, IsBlackWhereImagesAgree) {
  EXPECT_EQ(error_map(flat(1, 2, 3), flat(1, 2, 3)).data, flat(0, 0, 0).data);
}

TEST(ErrorMap, GrowsBrighterWithTheErrorUntilItIsFull) {
  float before = -1;
  for (const float error : {0.0F, 0.02F, 0.05F, 0.1F, 0.15F, 0.19F}) {
    const float now = luminance(error_map(flat(1, 1, 1), flat(1 + error, 1, 1 - error), 0.2 * 2 / 3));
    EXPECT_GT(now, before) << error;
    before = now;
  }
  const Image full = error_map(flat(1, 1, 1), flat(1.3F, 1.3F, 1.3F), 0.2);
  EXPECT_EQ(full.data, error_map(flat(1, 1, 1), flat(9, 9, 9), 0.2).data);
}

TEST(ErrorMap, ShowsWhatIsNotANumberAsFullError) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(error_map(flat(1, 1, 1), flat(nan, 1, 1)).data, error_map(flat(1, 1, 1), flat(9, 9, 9)).data);
}

TEST(ErrorMap, ScaleRunsFromNothingToFull) {
  const Image scale = error_scale(100, 20);
  const Image full = error_map(flat(1, 1, 1), flat(9, 9, 9));
  EXPECT_EQ(scale.at(10, 10, 0), 0);
  EXPECT_EQ(scale.at(89, 10, 0), full.at(0, 0, 0));
  EXPECT_EQ(scale.at(89, 10, 2), full.at(0, 0, 2));
}

TEST(SignedMap, PutsZeroAtGrey) {
  const Image map = signed_map(flat(-0.1F, 0, 0.1F), 1);
  EXPECT_LT(map.at(0, 0, 0), map.at(0, 0, 1));
  EXPECT_GT(map.at(0, 0, 2), map.at(0, 0, 1));
  EXPECT_FLOAT_EQ(map.at(0, 0, 1) - map.at(0, 0, 0), 0.1F);
}

}  // namespace
}  // namespace spectrace
