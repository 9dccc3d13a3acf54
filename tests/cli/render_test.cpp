// SPDX-License-Identifier: Apache-2.0
// What the program writes: images that do not depend on threads, layers that sum, separations that are kept.
#include <algorithm>
#include <cmath>
#include <regex>

#include "core/image/image.h"
#include "materials/measured_tables.h"
#include "renderer/features.h"
#include "tests/cli/program.h"
#include "tests/support/synthetic_measured.h"

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

/// Those with something to separate.
std::vector<std::string> measured_scene_names() {
  std::vector<std::string> names = scene_names();
  std::erase_if(names, [](const std::string& name) {
    return read_text(kScenes / name).find("\"measured\"") == std::string::npos;
  });
  return names;
}

class EveryScene : public Program, public ::testing::WithParamInterface<std::string> {
 protected:
  /// The folder of scenes, in which this one has a film of a sixteenth of the pixels and the demo's measured
  /// material is a small one.
  void SetUp() override {
    std::filesystem::create_directory(folder_ / "scenes");
    for (const auto& entry : std::filesystem::directory_iterator(kScenes)) {
      if (entry.path().filename() != GetParam())
        std::filesystem::create_symlink(entry.path(), folder_.path() / "scenes" / entry.path().filename());
    }
    const std::regex size(R"re(("width": )(\d+)(, "height": )(\d+))re");
    const std::string text = read_text(kScenes / GetParam());
    std::smatch found;
    ASSERT_TRUE(std::regex_search(text, found, size));
    const auto quarter = [&](std::size_t group) { return std::to_string(std::stoi(found.str(group)) / 4); };
    write_text(folder_ / scene_, found.prefix().str() + found.str(1) + quarter(2) + found.str(3) +
                                     quarter(4) + found.suffix().str());
    std::filesystem::create_directory(folder_ / "demo-out");
    write_measured("demo-out/pearlescent.bsdf");
  }
  Image render(const std::string& output, const std::vector<std::string>& options) const {
    std::vector<std::string> arguments{scene_, "-o", output, "--spp", "1"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    return read_image(folder_ / output);
  }

  const std::string scene_ = "scenes/" + GetParam();
};
class MeasuredScene : public EveryScene {};

TEST_P(EveryScene, IsTheSameBitForBitWithOneTwoAndSevenThreads) {
  const Image one = render("one.exr", {"--threads", "1"});
  EXPECT_GT(one.data.size(), 0U);
  EXPECT_EQ(render("two.exr", {"--threads", "2"}).data, one.data);
  EXPECT_EQ(render("seven.exr", {"--threads", "7"}).data, one.data);
  EXPECT_NE(render("other.exr", {"--seed", "1"}).data, one.data) << "the seed has no effect";
}

TEST_P(EveryScene, IsTheSameBitForBitByTheFullKernel) {
  std::vector<std::string> everything;
  for (const FeatureInfo& info : kFeatureInfos) {
    everything.emplace_back("--force-effect");
    everything.emplace_back(info.id);
  }
  EXPECT_EQ(render("lean.exr", {}).data, render("full.exr", everything).data);
  EXPECT_EQ(std::get<std::string>(read_metadata(folder_ / "full.exr").at("spectrace:kernel")), "full");
}

/// "R" of the beauty, "diffuse.R" of a layer.
std::string channel_of(const std::string& layer, const char* channel) {
  return layer.empty() ? channel : layer + "." + channel;
}

/// In every pixel: `whole` is the sum of those of `parts` that the image has, of which there must be
/// `at_least`.
void expect_sum(const Image& image, const std::string& whole, const std::vector<std::string>& parts,
                std::size_t at_least) {
  constexpr double kRelative =
      1e-5;  // the promise: interfaces say "to float rounding", sums have 2 to 4 terms
  for (const char* channel : {"R", "G", "B"}) {
    const auto sum_of_it = image.find_channel(channel_of(whole, channel));
    ASSERT_TRUE(sum_of_it.has_value()) << whole;
    std::vector<std::size_t> terms;
    for (const std::string& part : parts) {
      if (const auto found = image.find_channel(channel_of(part, channel))) terms.push_back(*found);
    }
    ASSERT_GE(terms.size(), at_least) << whole;
    for (int y = 0; y < image.height; ++y) {
      for (int x = 0; x < image.width; ++x) {
        double sum = 0, magnitude = 0;
        for (const std::size_t term : terms) {
          sum += image.at(x, y, term);
          magnitude += std::abs(image.at(x, y, term));
        }
        ASSERT_TRUE(std::isfinite(sum)) << x << ' ' << y;
        ASSERT_LE(std::abs(image.at(x, y, *sum_of_it) - sum), kRelative * magnitude)
            << whole << '.' << channel << " at " << x << ' ' << y;
      }
    }
  }
}

void expect_all_sums(const Image& image) {
  expect_sum(image, "", {"diffuse", "specular", "emission", "background"}, 4);
  expect_sum(image, "diffuse", {"diffuse_direct", "diffuse_indirect"}, 2);
  expect_sum(image, "specular", {"specular_direct", "specular_indirect"}, 2);
}

TEST_P(EveryScene, AllAovsSumToTheBeautyAndEveryPixelIsFinite) {
  const Image image = render("out.exr", {"--aovs", "all"});
  expect_all_sums(image);
}

TEST_P(MeasuredScene, AllAovsSumToTheBeautyWhereItIsSeparatedInEveryWay) {
  for (const char* model : {"sun", "fresnel", "diffraction", "residual"}) {
    const Image image = render(
        "out.exr", {"--aovs", "all", "--separate", model, "--cache", "kept", "--grid", kSmallGrid.back()});
    expect_all_sums(image);
    const bool has_parts = std::string(model) != "sun" && std::string(model) != "fresnel";
    EXPECT_EQ(image.find_channel("specular_diffraction.R").has_value(), has_parts) << model;
    if (!has_parts) continue;
    expect_sum(image, "specular", {"specular_fresnel", "specular_diffraction", "specular_residual"}, 2);
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, EveryScene, ::testing::ValuesIn(scene_names()),
                         [](const auto& scene) { return scene.param.substr(0, scene.param.find('.')); });
INSTANTIATE_TEST_SUITE_P(Scenes, MeasuredScene, ::testing::ValuesIn(measured_scene_names()),
                         [](const auto& scene) { return scene.param.substr(0, scene.param.find('.')); });

using Render = Program;

TEST_F(Render, NamesItsOutputAfterTheSceneUnlessTold) {
  write_lambert_scene("ball.json");
  const ProgramResult result = run({"ball.json"});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_EQ(names(), (std::vector<std::string>{"ball.exr", "ball.json", "ball.png"}));
}

TEST_F(Render, HeadersSayWhereTheImagesCameFrom) {
  write_lambert_scene("ball.json");
  std::string text = read_text(folder_ / "ball.json");
  text.replace(text.find("\"height\": 16"), 12, R"("height": 16, "spectral": {"bins": 3})");
  write_text(folder_ / "ball.json", text);
  ASSERT_EQ(run({"ball.json", "-o", "a.exr", "--spp", "3", "--seed", "5"}).exit_code, 0);
  for (const char* file : {"a.exr", "a.spectral.exr", "a.diffuse.spectral.exr", "a.specular.spectral.exr"}) {
    const Metadata metadata = read_metadata(folder_ / file);
    for (const char* name : {"version",         "commit",         "sceneFile",        "sceneSha256",
                             "materialSha256s", "seconds",        "threads",          "isa",
                             "lambdaMinNm",     "lambdaMaxNm",    "observer",         "units",
                             "binMeasure",      "kernel",         "effectsUsed",      "effectsSkipped",
                             "approximations",  "invalidSamples", "measuredVertices", "extrapolatedShare"}) {
      EXPECT_TRUE(metadata.contains(std::string("spectrace:") + name)) << file << ": " << name;
    }
    EXPECT_EQ(std::get<std::int64_t>(metadata.at("spectrace:spp")), 3) << file;
    EXPECT_EQ(std::get<std::string>(metadata.at("spectrace:seed")), "5") << file;
    EXPECT_EQ(std::get<std::string>(metadata.at("spectrace:sampleRange")), "0:3") << file;
    EXPECT_EQ(std::get<std::string>(metadata.at("spectrace:observer")), "CIE 1931 2 degree") << file;
    const bool has_bins = std::string(file) != "a.exr";
    EXPECT_EQ(std::get<std::string>(metadata.at("spectrace:binMeasure")),
              has_bins ? "mean W.m^-2.sr^-1.nm^-1 over the bin" : "no bins");
    EXPECT_EQ(metadata.contains("spectralLayoutVersion"), has_bins);
  }
}

TEST_F(Render, ListsEffectsWithoutRendering) {
  write_lambert_scene("ball.json");
  const ProgramResult result = run({"ball.json", "--effects"});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_TRUE(result.says("simulated      indirect light: max_depth is above 1")) << result.output;
  EXPECT_TRUE(result.says("not simulated  dispersion: ")) << result.output;
  EXPECT_EQ(names(), (std::vector<std::string>{"ball.json"}));
}

TEST_F(Render, SaysWhatItLeftOut) {
  write_lambert_scene("ball.json");
  const ProgramResult exact = run({"ball.json", "-o", "exact.exr"});
  const ProgramResult result =
      run({"ball.json", "-o", "a.exr", "--forbid-effect", "indirect-light", "--forbid-effect", "dispersion"});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_TRUE(result.complains("dispersion is forbidden, but nothing in the scene has it")) << result.errors;
  const Metadata metadata = read_metadata(folder_ / "a.exr");
  const auto approximations = std::get<std::string>(metadata.at("spectrace:approximations"));
  EXPECT_TRUE(approximations.starts_with("without indirect-light: ")) << approximations;
  EXPECT_TRUE(result.says("approximation " + approximations)) << result.output;
  EXPECT_EQ(std::get<std::string>(read_metadata(folder_ / "exact.exr").at("spectrace:approximations")), "");
  EXPECT_EQ(run({"ball.json", "--forbid-effect", "instances"}).exit_code, 2);  // nothing stands for them
}

TEST_F(Render, PartsOfAnApproximationJoinNoOthers) {
  write_lambert_scene("ball.json");
  ASSERT_EQ(run({"ball.json", "-o", "a.exr", "--samples", "0:8"}).exit_code, 0);
  ASSERT_EQ(
      run({"ball.json", "-o", "b.exr", "--samples", "8:16", "--forbid-effect", "indirect-light"}).exit_code,
      0);
  const ProgramResult result = run({"merge", "a.partial", "b.partial", "-o", "c.exr"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_TRUE(result.complains("without indirect-light")) << result.errors;
}

TEST_F(Render, SaysWhereAMeasurementReflectsTooMuchAndHowMuchOfItIsNone) {
  MeasuredTables bright = make_measured({});
  for (float& x : bright.spectra) x *= 100;
  measured_to_tensors(bright).write(folder_ / "bright.bsdf");
  write_scene("bright.json", R"({"name": "m", "type": "measured", "file": "bright.bsdf"})");
  const ProgramResult result = run({"bright.json", "-o", "bright.exr"});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_TRUE(result.complains("m: albedo ")) << result.errors;
  // A ball is seen at every elevation, so also at those that were not measured.
  EXPECT_TRUE(result.says("extrapolated: ")) << result.output;
  EXPECT_TRUE(run({"inspect", "bright.bsdf"}).says("reflects more light than it receives"));

  write_lambert_scene("ball.json");
  const ProgramResult plain = run({"ball.json"});
  EXPECT_FALSE(plain.complains("albedo")) << plain.errors;
  EXPECT_FALSE(plain.says("extrapolated")) << plain.output;
}

TEST_F(Render, SeparatesOnceAndKeepsTheResult) {
  write_measured("m.bsdf");
  write_scene("scene.json", R"({"name": "m", "type": "measured", "file": "m.bsdf"})");
  const auto render = [&](const std::string& model, const std::string& output,
                          const std::string& grid = "24x20x30") {
    return run({"scene.json", "--separate", model, "-o", output, "--cache", "kept", "--grid", grid});
  };
  const auto separations = [&] {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_.path())) {
      if (entry.path().extension() == ".sep") files.push_back(entry.path());
    }
    return files;
  };
  ASSERT_EQ(render("fresnel", "first.exr").exit_code, 0);
  ASSERT_EQ(separations().size(), 1U);
  const std::filesystem::path kept = separations().front();
  const auto written = std::filesystem::last_write_time(kept);
  const std::string content = read_text(kept);

  ASSERT_EQ(render("fresnel", "second.exr").exit_code, 0);
  EXPECT_EQ(separations(), std::vector<std::filesystem::path>{kept});
  EXPECT_EQ(std::filesystem::last_write_time(kept), written);
  EXPECT_EQ(read_image(folder_ / "first.exr").data, read_image(folder_ / "second.exr").data);

  // Unless told otherwise, pictures of different models are different files.
  ASSERT_EQ(run({"scene.json", "--separate", "sun", "--cache", "kept", "--grid", "24x20x30"}).exit_code, 0);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "scene-sun.exr"));

  // Another model is in the same file; a damaged one is made again.
  ASSERT_EQ(render("sun", "sun.exr").exit_code, 0);
  EXPECT_EQ(std::filesystem::last_write_time(kept), written);
  write_text(kept, content.substr(0, content.size() / 2));
  ASSERT_EQ(render("fresnel", "third.exr").exit_code, 0);
  EXPECT_EQ(read_text(kept), content);
  EXPECT_EQ(read_image(folder_ / "first.exr").data, read_image(folder_ / "third.exr").data);

  // Another grid is another separation.
  ASSERT_EQ(render("fresnel", "coarse.exr", "12x8x6").exit_code, 0);
  EXPECT_EQ(separations().size(), 2U);
}

}  // namespace
}  // namespace spectrace::test
