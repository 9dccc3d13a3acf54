// SPDX-License-Identifier: Apache-2.0
// Real measurements, separated and rendered, against the picture of the measurement itself.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>

#include "core/image/metrics.h"
#include "materials/separated_brdf.h"
#include "separation/compact.h"
#include "separation/separate.h"
#include "tests/support/render_scenes.h"
#include "tests/support/test_data.h"

namespace spectrace::test {
namespace {

namespace fs = std::filesystem;

/// A ball of a measured material under a real sky, described in any way, always on the same directions.
class RealBall {
 public:
  explicit RealBall(const fs::path& measurement) : measured_(read_measured(measurement)) {
    SeparationOptions options;
    options.grid = {.n_theta_h = 60, .n_theta_d = 60, .n_phi_d = 60};  // a fifth of the paper's: time
    options.residual_rank = kDefaultResidualRank;
    SilentProgress progress;
    const SeparationResult result = separate(measured_, options, progress);
    EXPECT_TRUE(result.report.usable) << result.report.verdict;
    tables_ = std::make_shared<const CompactTables>(compact(result.tables, kDefaultQuality).tables);

    SceneDesc description = empty_scene();
    description.film = {48, 48};
    description.camera.fov_deg = 26;
    description.integrator = {.max_depth = 1};
    description.materials = {lambert("ball", Float(0.5))};
    description.shapes = {sphere({0, 0, 0}, 1, "ball")};
    description.lights = {EnvironmentDesc{.file = data_folder() / "envmaps" / "brown_photostudio_02_1k.hdr"}};
    scene_ = std::make_unique<Scene>(build_scene(description, progress));
  }

  Image raw() { return render_as(measured_); }
  Image of(SeparationModel model) { return render_as(SeparatedBrdf(tables_, model)); }

 private:
  Image render_as(PairedBrdf::Values values) {
    scene_->materials[0] =
        PairedBrdf(std::move(values), SeparatedBrdf(tables_, SeparationModel::kDiffraction));
    SilentProgress progress;
    const RenderResult result = render(*scene_, {.spp = 32, .aovs = kNoAovs}, progress);
    EXPECT_EQ(result.report.invalid_samples, 0U);
    const auto names = rgb_channels("");
    Image rgb = result.image.select(names, "rendered");
    for (float x : rgb.data) EXPECT_TRUE(std::isfinite(x) && x >= 0) << x;
    return rgb;
  }

  MeasuredBrdf measured_;
  std::shared_ptr<const CompactTables> tables_;
  std::unique_ptr<Scene> scene_;
};

struct RealCase {
  std::string file;
  double fresnel_over_sun_db;      ///< at least: 2 dB below what this ball gave, and never below sun
  double diffraction_over_sun_db;  ///< at least: 2 dB below what 128 x 128 pixels on the paper's grid gave
};

class RealInput : public testing::TestWithParam<RealCase> {};

TEST_P(RealInput, RicherModelsAreCloserToTheMeasurement) {
  const fs::path file = data_folder() / GetParam().file;
  if (!fs::exists(file)) GTEST_SKIP() << "needs " << file << " (set SPECTRACE_DATA)";
  RealBall ball(file);
  const Image raw = ball.raw();
  const auto psnr = [&](SeparationModel model) { return compare_images(raw, ball.of(model)).psnr_db; };
  const double sun = psnr(SeparationModel::kSun), fresnel = psnr(SeparationModel::kFresnel),
               diffraction = psnr(SeparationModel::kDiffraction), residual = psnr(SeparationModel::kResidual);
  EXPECT_GT(fresnel, sun + GetParam().fresnel_over_sun_db);
  EXPECT_GT(diffraction, sun + GetParam().diffraction_over_sun_db);
  EXPECT_GT(residual, diffraction);
  RecordProperty("psnr", std::to_string(sun) + " " + std::to_string(fresnel) + " " +
                             std::to_string(diffraction) + " " + std::to_string(residual));
}

INSTANTIATE_TEST_SUITE_P(All, RealInput,
                         testing::Values(RealCase{"epfl_rgb/irid_flake_paint2_rgb.bsdf", 0, 5},
                                         RealCase{"epfl_rgb/cc_nothern_aurora_rgb.bsdf", 7.8, 8},
                                         RealCase{"epfl_rgb/vch_ultra_pink_rgb.bsdf", 8.1, 8}),
                         [](const auto& real) { return fs::path(real.param.file).stem().string(); });

}  // namespace
}  // namespace spectrace::test
