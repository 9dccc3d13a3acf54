// SPDX-License-Identifier: Apache-2.0
// Renders against stored ones of the same scenes, by the program's own z-test (docs/compare.md). Mean and
// variance come from renders with independent seeds: so the variance is that of the sampler as it is, with
// all that its stratification saves.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstdlib>

#include "core/image/channel_groups.h"
#include "renderer/render.h"
#include "tests/support/run_program.h"

namespace spectrace::test {
namespace {

constexpr int kSize = 40;  // pixels; with three layers and their variances up to 80 kB a scene
constexpr const char* kUpdate = "SPECTRACE_UPDATE_REFERENCES";

struct Effort {
  int renders, spp;
  std::uint64_t first_seed;
};
// Many short renders rather than few long ones: of 32, variances are so uncertain themselves that z has the
// tails of Student's distribution. A reference's noise is about a quarter of that of the image under test.
constexpr Effort kReference{.renders = 512, .spp = 16, .first_seed = 1000};
constexpr Effort kTest{.renders = 128, .spp = 4, .first_seed = 1};

const std::vector<std::string>& layers() {
  static const std::vector<std::string> names{"beauty", "diffuse", "specular"};
  return names;
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

/// The layers' means over all renders, and the variance of these means.
Image mean_and_variance(const Scene& scene, const Effort& effort) {
  std::vector<std::string> colours, all;
  for (const std::string& layer : layers()) {
    for (const std::string& channel : channels_of(layer)) colours.push_back(channel);
  }
  all = colours;
  for (const std::string& layer : layers()) {
    for (const std::string& channel : rgb_channels(variance_of(layer))) all.push_back(channel);
  }
  SilentProgress progress;
  std::vector<double> sums(std::size_t(kSize) * kSize * colours.size()), squares(sums.size());
  for (int i = 0; i < effort.renders; ++i) {
    const RenderOptions options{.spp = effort.spp, .seed = effort.first_seed + std::uint64_t(i)};
    const Image image = render(scene, options, progress).image.select(colours, "render");
    for (std::size_t k = 0; k < sums.size(); ++k) {
      sums[k] += double(image.data[k]);
      squares[k] += double(image.data[k]) * double(image.data[k]);
    }
  }
  const double n = effort.renders;
  Image result(kSize, kSize, all);
  for (std::size_t k = 0; k < sums.size(); ++k) {
    const std::size_t pixel = k / colours.size(), c = k % colours.size();
    const double mean = sums[k] / n;
    const double variance = std::max(squares[k] / n - mean * mean, 0.0) / (n - 1);
    result.data[pixel * all.size() + c] = static_cast<float>(mean);
    result.data[pixel * all.size() + colours.size() + c] = rounded(variance);
  }
  return result;
}

class References : public testing::TestWithParam<const char*> {
 protected:
  static Scene small_scene() {
    SceneDesc description = load_scene(std::filesystem::path(SPECTRACE_SOURCE_DIR) / "scenes" /
                                       (std::string(GetParam()) + ".json"));
    description.film.width = description.film.height = kSize;
    SilentProgress progress;
    return build_scene(description, progress);
  }
};

INSTANTIATE_TEST_SUITE_P(Scenes, References,
                         testing::Values("cornell_box", "glass_and_coats", "sphere_checkerboard"),
                         [](const auto& tested) { return std::string(tested.param); });

TEST_P(References, AreMetByRendersOfToday) {
  const std::filesystem::path folder = std::filesystem::path(SPECTRACE_SOURCE_DIR) / "tests" / "references";
  const std::filesystem::path reference = folder / (std::string(GetParam()) + ".exr");
  const Scene scene = small_scene();
  if (std::getenv(kUpdate) != nullptr) {  // NOLINT(concurrency-mt-unsafe): no other thread
    write_exr(reference, mean_and_variance(scene, kReference), {});
  }
  const TemporaryFolder today;
  write_exr(today / "test.exr", mean_and_variance(scene, kTest), {});
  const ProgramResult result = run_spectrace({"compare", reference.string(), (today / "test.exr").string(),
                                              "--limits", (folder / "limits.json").string()});
  EXPECT_EQ(result.exit_code, 0) << result.output << result.errors
                                 << "docs/validation.md tells how to look at it, "
                                 << "and how to take new references";
  for (const std::string& layer : layers())
    EXPECT_TRUE(result.says("pass: " + layer + " z-test")) << result.output;
}

}  // namespace
}  // namespace spectrace::test
