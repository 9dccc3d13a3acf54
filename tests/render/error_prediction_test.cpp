// SPDX-License-Identifier: Apache-2.0
// What is fitted to a ladder of samples predicts the error of renders that were not on it.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "core/image/error_model.h"
#include "core/image/metrics.h"
#include "renderer/render.h"

namespace spectrace::test {
namespace {

constexpr int kSize = 64;

class Prediction : public ::testing::TestWithParam<const char*> {
 protected:
  Prediction() : scene_(build()) {}

  Image beauty(int spp, std::uint64_t seed) const {
    SilentProgress progress;
    const std::array<std::string, 3> channels{"R", "G", "B"};
    return render(scene_, {.spp = spp, .seed = seed, .aovs = kNoAovs}, progress)
        .image.select(channels, "render");
  }

 private:
  static Scene build() {
    SceneDesc scene = load_scene(std::string(SPECTRACE_SOURCE_DIR "/scenes/") + GetParam() + ".json");
    scene.film.width = scene.film.height = kSize;
    SilentProgress progress;
    return build_scene(scene, progress);
  }
  Scene scene_;
};

TEST_P(Prediction, HoldsBetweenAndBeyondWhatWasMeasured) {
  const Image a = beauty(512, 1000), b = beauty(512, 1001);
  Image reference = a;
  double mean = 0;
  for (std::size_t i = 0; i < a.data.size(); ++i) {
    reference.data[i] = (a.data[i] + b.data[i]) / 2;
    mean += double(reference.data[i]) / double(a.data.size());
  }
  const MetricOptions metrics{.epsilon = kRelativeEpsilon * mean * mean};
  const double known = noise_rel_mse({a, b}, metrics.epsilon).value;
  std::vector<ErrorPoint> ladder;
  for (const int spp : {8, 16, 32, 64}) {
    // The time does not matter here.
    ladder.push_back(
        {double(spp), 1, compare_images(reference, beauty(spp, std::uint64_t(spp)), metrics).rel_mse});
  }
  const ErrorModel model = fit_error_model(ladder, 0, known);
  for (const int spp : {48, 128}) {
    const double rel_mse = compare_images(reference, beauty(spp, std::uint64_t(spp)), metrics).rel_mse - known;
    const double measured = std::sqrt(rel_mse);
    EXPECT_NEAR(std::sqrt(model.rel_mse(spp)), measured, 0.25 * measured)
        << spp << " samples; noise falls with exponent " << model.exponent;
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, Prediction, ::testing::Values("cornell_box", "glass_and_coats", "instances"),
                         [](const auto& test) { return std::string(test.param); });

}  // namespace
}  // namespace spectrace::test
