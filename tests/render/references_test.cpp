// SPDX-License-Identifier: Apache-2.0
// Renders against stored ones of the same scenes, by the program's own z-test (docs/compare.md). Mean and
// variance come from renders with independent seeds: so the variance is that of the sampler as it is, with
// all that its stratification saves.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <ostream>
#include <string>

#include "core/image/channel_groups.h"
#include "renderer/render.h"
#include "tests/support/run_program.h"

namespace spectrace::test {
namespace {

constexpr const char* kUpdate = "SPECTRACE_UPDATE_REFERENCES";

struct Effort {
  int renders, spp;
  std::uint64_t first_seed;
};
// Many short renders rather than few long ones: of 32, variances are so uncertain themselves that z has the
// tails of Student's distribution. A reference's noise is about a quarter of that of the image under test.
constexpr Effort kReference{.renders = 512, .spp = 16, .first_seed = 1000};
constexpr Effort kTest{.renders = 128, .spp = 4, .first_seed = 1};
// Fewer pixels, and as many samples as the reference has: so that 1 % of any lobe is more than noise.
constexpr Effort kLobeTest{.renders = 128, .spp = 64, .first_seed = 1};

struct Case {
  const char* name;    // of the reference
  const char* folder;  // of the scene
  int size;            // pixels a side: with the layers and their variances up to 80 kB a scene
  Effort test;
  std::vector<std::string> layers;
  std::vector<std::string> biased;  // layers in which 1 % is more than noise

  friend void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }  // for GoogleTest
};

std::vector<Case> cases() {
  const std::vector<std::string> layers{"beauty", "diffuse", "specular"};
  const std::vector<std::string> lobes{"diffuse",          "specular",        "diffuse_direct",
                                       "diffuse_indirect", "specular_direct", "specular_indirect"};
  return {{"cornell_box", "scenes", 40, kTest, layers, {"diffuse"}},
          {"glass_and_coats", "scenes", 40, kTest, layers, {"diffuse"}},
          {"sphere_checkerboard", "scenes", 40, kTest, layers, {"diffuse"}},
          {"lobes", "tests/references", 20, kLobeTest, lobes, lobes}};
}

std::vector<std::string> channels_of(const std::string& layer) {
  const auto names = rgb_channels(layer == "beauty" ? "" : layer);
  return {names.begin(), names.end()};
}

/// Eight bits of mantissa are more than an estimated variance is worth, and compress to half the size.
float rounded(double variance) {
  constexpr std::uint32_t kKept = 0xffff8000;
  return std::bit_cast<float>(std::bit_cast<std::uint32_t>(static_cast<float>(variance)) & kKept);
}

Scene small_scene(const Case& of) {
  SceneDesc description =
      load_scene(std::filesystem::path(SPECTRACE_SOURCE_DIR) / of.folder / (std::string(of.name) + ".json"));
  description.film.width = description.film.height = of.size;
  SilentProgress progress;
  return build_scene(description, progress);
}

/// The layers' means over all renders, and the variance of these means.
Image mean_and_variance(const Case& of, const Effort& effort) {
  const Scene scene = small_scene(of);
  std::vector<std::string> colours, all;
  for (const std::string& layer : of.layers) {
    for (const std::string& channel : channels_of(layer)) colours.push_back(channel);
  }
  all = colours;
  for (const std::string& layer : of.layers) {
    for (const std::string& channel : rgb_channels(variance_of(layer))) all.push_back(channel);
  }
  AovSet aovs = kLobeAovs;
  for (const std::string& layer : of.layers) {
    const bool is_unknown = layer != "beauty" && add_aov(layer, aovs).has_value();
    EXPECT_FALSE(is_unknown) << layer;
  }
  SilentProgress progress;
  std::vector<double> sums(std::size_t(of.size) * std::size_t(of.size) * colours.size()),
      squares(sums.size());
  for (int i = 0; i < effort.renders; ++i) {
    const RenderOptions options{
        .spp = effort.spp, .seed = effort.first_seed + std::uint64_t(i), .aovs = aovs};
    const Image image = render(scene, options, progress).image.select(colours, "render");
    for (std::size_t k = 0; k < sums.size(); ++k) {
      sums[k] += double(image.data[k]);
      squares[k] += double(image.data[k]) * double(image.data[k]);
    }
  }
  const double n = effort.renders;
  Image result(of.size, of.size, all);
  for (std::size_t k = 0; k < sums.size(); ++k) {
    const std::size_t pixel = k / colours.size(), c = k % colours.size();
    const double mean = sums[k] / n;
    const double variance = std::max(squares[k] / n - mean * mean, 0.0) / (n - 1);
    result.data[pixel * all.size() + c] = static_cast<float>(mean);
    result.data[pixel * all.size() + colours.size() + c] = rounded(variance);
  }
  return result;
}

const std::filesystem::path kFolder = std::filesystem::path(SPECTRACE_SOURCE_DIR) / "tests" / "references";

std::filesystem::path reference_of(const std::string& scene) { return kFolder / (scene + ".exr"); }

/// Rendered once, for all tests of a scene.
const Image& render_of_today(const Case& of) {
  static std::map<std::string, Image> rendered;
  const auto it = rendered.find(of.name);
  return it != rendered.end() ? it->second
                              : rendered.emplace(of.name, mean_and_variance(of, of.test)).first->second;
}

ProgramResult compare(const std::string& scene, const Image& test) {
  const TemporaryFolder folder;
  write_exr(folder / "test.exr", test, {});
  return run_spectrace({"compare", reference_of(scene).string(), (folder / "test.exr").string(), "--limits",
                        (kFolder / "limits.json").string()});
}

class References : public testing::TestWithParam<Case> {};

INSTANTIATE_TEST_SUITE_P(Scenes, References, testing::ValuesIn(cases()),
                         [](const auto& tested) { return std::string(tested.param.name); });

TEST_P(References, AreMetByRendersOfToday) {
  const Case& of = GetParam();
  if (std::getenv(kUpdate) != nullptr) {  // NOLINT(concurrency-mt-unsafe): no other thread
    write_exr(reference_of(of.name), mean_and_variance(of, kReference), {});
  }
  const ProgramResult result = compare(of.name, render_of_today(of));
  EXPECT_EQ(result.exit_code, 0) << result.output << result.errors
                                 << "docs/validation.md tells how to look at it, "
                                 << "and how to take new references";
  for (const std::string& layer : of.layers)
    EXPECT_TRUE(result.says("pass: " + layer + " z-test")) << result.output;
}

TEST_P(References, FindOnePercentTooMuchInOneLobe) {
  const Case& of = GetParam();
  for (const std::string& lobe : of.biased) {
    Image biased = render_of_today(of);
    for (const std::string& channel : channels_of(lobe)) {
      const std::size_t c = biased.find_channel(channel).value();
      for (std::size_t i = c; i < biased.data.size(); i += biased.channels.size()) biased.data[i] *= 1.01F;
    }
    const ProgramResult result = compare(of.name, biased);
    EXPECT_EQ(result.exit_code, 1) << result.output;
    for (const std::string& layer : of.layers) {
      const std::string verdict = layer == lobe ? "FAIL: " : "pass: ";
      EXPECT_TRUE(result.says(verdict + layer + " z-test")) << result.output;
    }
  }
}

}  // namespace
}  // namespace spectrace::test
