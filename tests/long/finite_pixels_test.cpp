// SPDX-License-Identifier: Apache-2.0
// 512 samples a pixel of every scene of scenes/ and of a hundred random ones: no pixel that is not finite, no
// sample dropped.
#include <gtest/gtest.h>

#include <cmath>

#include "materials/measured_tables.h"
#include "tests/support/random_scene.h"
#include "tests/support/render_scenes.h"
#include "tests/support/synthetic_measured.h"
#include "tests/support/temporary_folder.h"

namespace spectrace::test {
namespace {

constexpr int kSamples = 512;

/// Whether there is any light in it.
bool renders_finite(const SceneDesc& scene) {
  const RenderResult result = render_scene(scene, kSamples);
  EXPECT_EQ(result.report.invalid_samples, 0U);
  std::size_t bad = 0, lit = 0;
  for (const float value : result.image.data) {
    bad += std::isfinite(value) ? 0 : 1;
    lit += value > 0 ? 1 : 0;
  }
  EXPECT_EQ(bad, 0U) << "values are not finite";
  return lit > 0;
}

TEST(FinitePixels, OfAHundredRandomScenes) {
  int lit = 0;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    lit += renders_finite(random_scene(seed)) ? 1 : 0;
  }
  EXPECT_GE(lit, 80) << "the others show nothing";
}

TEST(FinitePixels, OfEveryShippedScene) {
  const TemporaryFolder folder;
  const auto scenes = std::filesystem::path(SPECTRACE_SOURCE_DIR) / "scenes";
  std::filesystem::copy(scenes, folder / "scenes", std::filesystem::copy_options::recursive);
  std::filesystem::create_directory(folder / "demo-out");  // what scripts/demo.sh would make
  measured_to_tensors(make_measured({})).write(folder / "demo-out/pearlescent.bsdf");
  std::size_t rendered = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "scenes")) {
    const std::string name = entry.path().filename().string();
    if (!name.ends_with(".json") || name.ends_with("schema.json")) continue;
    SCOPED_TRACE(name);
    SceneDesc scene = load_scene(entry.path());
    scene.film = {48, 36};
    EXPECT_TRUE(renders_finite(scene)) << "all is dark";
    ++rendered;
  }
  EXPECT_GE(rendered, 7U);
}

}  // namespace
}  // namespace spectrace::test
