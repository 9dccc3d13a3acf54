// SPDX-License-Identifier: Apache-2.0
// What the program writes: images that do not depend on threads, layers that sum, separations that are kept.
#include <algorithm>
#include <cmath>

#include "core/image/image.h"
#include "tests/cli/program.h"

namespace spectrace::test {
namespace {

/// Every scene that comes along, by file name.
std::vector<std::string> scene_names() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(kScenes)) {
    const std::string name = entry.path().filename().string();
    if (name.ends_with(".json") && name != "scene.schema.json") names.push_back(name);
  }
  std::sort(names.begin(), names.end());
  return names;
}

class EveryScene : public Program, public ::testing::WithParamInterface<std::string> {
 protected:
  /// The scene, with the demo's measured material replaced by a small one.
  std::string scene_file() const {
    std::string text = read_text(kScenes / GetParam());
    const std::string measured = "../demo-out/pearlescent.bsdf";
    const std::size_t at = text.find(measured, text.find("\"materials\""));
    if (at == std::string::npos) return (kScenes / GetParam()).string();
    write_measured("measured.bsdf");
    text.replace(at, measured.size(), "measured.bsdf");
    write_text(folder_ / GetParam(), text);
    return (folder_ / GetParam()).string();
  }
  Image render(const std::string& output, const std::vector<std::string>& options) const {
    std::vector<std::string> arguments{scene_file(), "-o", output, "--spp", "1"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    return read_image(folder_ / output);
  }
};

TEST_P(EveryScene, IsTheSameBitForBitWithOneTwoAndSevenThreads) {
  const Image one = render("one.exr", {"--threads", "1"});
  EXPECT_GT(one.data.size(), 0U);
  EXPECT_EQ(render("two.exr", {"--threads", "2"}).data, one.data);
  EXPECT_EQ(render("seven.exr", {"--threads", "7"}).data, one.data);
  EXPECT_NE(render("other.exr", {"--seed", "1"}).data, one.data) << "the seed has no effect";
}

TEST_P(EveryScene, LayersSumToTheBeautyAndEveryPixelIsFinite) {
  const Image image = render("out.exr", {});
  constexpr double kRelative =
      1e-5;  // the promise: interfaces say "to float rounding", the sum has four terms
  for (const char* channel : {"R", "G", "B"}) {
    const auto index = [&](const std::string& layer) {
      const auto c = image.find_channel(layer + channel);
      EXPECT_TRUE(c.has_value()) << layer << channel;
      return c.value_or(0);
    };
    const std::size_t beauty = index("");
    const std::vector<std::size_t> layers{index("diffuse."), index("specular."), index("emission."),
                                          index("background.")};
    for (int y = 0; y < image.height; ++y) {
      for (int x = 0; x < image.width; ++x) {
        double sum = 0, magnitude = 0;
        for (const std::size_t layer : layers) {
          sum += image.at(x, y, layer);
          magnitude += std::abs(image.at(x, y, layer));
        }
        ASSERT_TRUE(std::isfinite(sum)) << x << ' ' << y;
        ASSERT_LE(std::abs(image.at(x, y, beauty) - sum), kRelative * magnitude) << x << ' ' << y << channel;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, EveryScene, ::testing::ValuesIn(scene_names()),
                         [](const auto& scene) { return scene.param.substr(0, scene.param.find('.')); });

using Render = Program;

TEST_F(Render, NamesItsOutputAfterTheSceneUnlessTold) {
  write_lambert_scene("ball.json");
  const ProgramResult result = run({"ball.json"});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_EQ(names(), (std::vector<std::string>{"ball.exr", "ball.json", "ball.png"}));
}

TEST_F(Render, HeaderSaysWhereTheImageCameFrom) {
  write_lambert_scene("ball.json");
  EXPECT_EQ(run({"ball.json", "-o", "a.exr", "--spp", "3", "--seed", "5"}).exit_code, 0);
  const Metadata metadata = read_metadata(folder_ / "a.exr");
  for (const char* name :
       {"version", "commit", "sceneFile", "sceneSha256", "materialSha256s", "seconds", "threads", "isa",
        "lambdaMinNm", "lambdaMaxNm", "units", "kernel", "effectsUsed", "effectsSkipped", "invalidSamples"}) {
    EXPECT_TRUE(metadata.contains(std::string("spectrace:") + name)) << name;
  }
  EXPECT_EQ(std::get<std::int64_t>(metadata.at("spectrace:spp")), 3);
  EXPECT_EQ(std::get<std::string>(metadata.at("spectrace:seed")), "5");
}

TEST_F(Render, SeparatesOnceAndKeepsTheResult) {
  write_measured("m.bsdf");
  write_scene("scene.json", R"({"name": "m", "type": "measured", "file": "m.bsdf"})");
  const auto separations = [&] {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_.path())) {
      if (entry.path().extension() == ".sep") files.push_back(entry.path());
    }
    return files;
  };
  ASSERT_EQ(run({"scene.json", "--separate", "fresnel", "-o", "first.exr", "--cache", "kept"}).exit_code, 0);
  ASSERT_EQ(separations().size(), 1U);
  const std::filesystem::path kept = separations().front();
  const auto written = std::filesystem::last_write_time(kept);
  const std::string content = read_text(kept);

  ASSERT_EQ(run({"scene.json", "--separate", "fresnel", "-o", "second.exr", "--cache", "kept"}).exit_code, 0);
  EXPECT_EQ(separations(), std::vector<std::filesystem::path>{kept});
  EXPECT_EQ(std::filesystem::last_write_time(kept), written);
  EXPECT_EQ(read_image(folder_ / "first.exr").data, read_image(folder_ / "second.exr").data);

  // Another model is in the same file; a damaged one is made again.
  ASSERT_EQ(run({"scene.json", "--separate", "sun", "-o", "sun.exr", "--cache", "kept"}).exit_code, 0);
  EXPECT_EQ(std::filesystem::last_write_time(kept), written);
  write_text(kept, content.substr(0, content.size() / 2));
  ASSERT_EQ(run({"scene.json", "--separate", "fresnel", "-o", "third.exr", "--cache", "kept"}).exit_code, 0);
  EXPECT_EQ(read_text(kept), content);
  EXPECT_EQ(read_image(folder_ / "first.exr").data, read_image(folder_ / "third.exr").data);
}

}  // namespace
}  // namespace spectrace::test
