// SPDX-License-Identifier: Apache-2.0
// What must hold in every scene: layers sum, threads and kernels change no bit.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "renderer/kernels.h"
#include "tests/support/render_scenes.h"
#include "tests/support/scene_zoo.h"

namespace spectrace::test {
namespace {

class EveryScene : public testing::TestWithParam<NamedScene> {
 protected:
  EveryScene() : scene_(build_scene(GetParam().scene, progress_)) {}
  Image render_with(RenderOptions options) { return render(scene_, options, progress_).image; }

  SilentProgress progress_;
  Scene scene_;
};

std::string test_name(const testing::TestParamInfo<NamedScene>& info) {
  std::string name;
  for (char c : info.param.name) name += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  return name;
}

bool same_bits(const Image& a, const Image& b) {
  return a.channels == b.channels && a.data.size() == b.data.size() &&
         std::memcmp(a.data.data(), b.data.data(), a.data.size() * sizeof(float)) == 0;
}

INSTANTIATE_TEST_SUITE_P(Zoo, EveryScene, testing::ValuesIn(scene_zoo()), test_name);

TEST_P(EveryScene, LayersSumToBeauty) {
  const Image image = render_with({.spp = 16});
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      double largest = 0;
      for (int c = 0; c < 15; ++c) largest = std::max(largest, std::abs(double(image.at(x, y, c))));
      for (int c = 0; c < 3; ++c) {
        double sum = 0;
        for (int layer = 1; layer <= 4; ++layer) sum += image.at(x, y, 3 * layer + c);
        EXPECT_NEAR(sum, image.at(x, y, c), 1e-5 * largest) << x << ", " << y << ", channel " << c;
      }
    }
  }
}

TEST_P(EveryScene, NothingIsInvalidAndLightIsThere) {
  const RenderResult result = render(scene_, {.spp = 16}, progress_);
  EXPECT_EQ(result.report.invalid_samples, 0U);
  double sum = 0;
  for (float value : result.image.data) {
    ASSERT_TRUE(std::isfinite(value));
    sum += std::abs(value);
  }
  EXPECT_EQ(sum > 0, GetParam().name != "empty");
}

TEST_P(EveryScene, ThreadsChangeNoBit) {
  const Image one = render_with({.spp = 8, .threads = 1});
  for (int threads : {2, 7}) {
    EXPECT_TRUE(same_bits(one, render_with({.spp = 8, .threads = threads}))) << threads << " threads";
  }
}

TEST_P(EveryScene, KernelsChangeNoBit) {
  const RenderResult lean = render(scene_, {.spp = 8}, progress_);
  const Features needed = required_features(scene_, kLobeAovs);
  int compared = 0;
  for (const Kernel& kernel : kernels()) {
    if (covers(kernel.features, needed) && kernel.name != lean.report.kernel) {
      EXPECT_TRUE(same_bits(lean.image, render_with({.spp = 8, .kernel = std::string(kernel.name)})))
          << kernel.name;
      ++compared;
    }
  }
  EXPECT_TRUE(compared > 0 || lean.report.kernel == "full");
}

TEST_P(EveryScene, BeautyAloneHasTheSameBits) {
  const Image all = render_with({.spp = 8});
  const Image alone = render_with({.spp = 8, .aovs = kNoAovs});
  EXPECT_EQ(alone.channels, (std::vector<std::string>{"R", "G", "B", "diagnostics.invalid"}));
  for (std::size_t i = 0; i < std::size_t(all.width) * all.height; ++i) {
    for (int c = 0; c < 3; ++c) {
      ASSERT_EQ(all.data[i * all.channels.size() + c], alone.data[i * 4 + c]);
    }
  }
}

TEST_P(EveryScene, ExtrapolationIsCountedWhereAMeasurementEnds) {
  const double share = render(scene_, {.spp = 4}, progress_).report.extrapolated_share;
  if (GetParam().name == "measured ball") {
    EXPECT_GT(share, 0);  // the ball's rim
    EXPECT_LT(share, 0.5);
  } else {
    EXPECT_EQ(share, 0);
  }
}

TEST_P(EveryScene, SeedsChangeTheNoise) {
  if (GetParam().name == "empty") return;
  EXPECT_FALSE(same_bits(render_with({.spp = 1}), render_with({.spp = 1, .seed = 1})));
}

}  // namespace
}  // namespace spectrace::test
