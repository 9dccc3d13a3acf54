// SPDX-License-Identifier: Apache-2.0
// H7 to H11: spectra of one peak, negative input, empty lobes, albedos above 1, narrow lobes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/hard_cases/every_measurement.h"
#include "tests/support/acquired.h"
#include "tests/support/chi_square.h"
#include "tests/support/render_scenes.h"
#include "tests/support/shading_point.h"
#include "tests/support/temporary_folder.h"

namespace spectrace::test {
namespace {

struct Weights {
  double largest = 0, mean = 0;  ///< of a lane: its mean is the albedo
};
Weights weights_of(const Material& material, double theta_deg, int lane, int samples) {
  TestRandom random(5);
  Weights w;
  for (int i = 0; i < samples; ++i) {
    const Float lobe = random.uniform();
    const auto s = sample(material, direction_deg(theta_deg, 40), {lobe, random.uniform2()}, kAt);
    if (!s) continue;
    w.largest = std::max(w.largest, double(s->weight[lane]));
    w.mean += double(s->weight[lane]) / samples;
  }
  return w;
}

constexpr double kLeastAlbedo = 0.001;  // of a lane that has next to none, nothing is a firefly

TEST(H07_OnePeak, WeightsAreBoundedByTheAlbedoOfTheirWavelength) {
  MeasuredTables tables = acquired_tables("gold");
  constexpr std::size_t kPeak = 3;  // 550 nm
  const std::size_t n = tables.axis.size(), cells = tables.luminance.size() / tables.slices();
  for (std::size_t i = 0; i < tables.spectra.size(); ++i) {
    tables.spectra[i] *= i / cells % n == kPeak ? 1e4F : 0;
  }
  const MeasuredBrdf brdf(tables);
  SilentProgress progress;
  SeparationOptions options;
  options.grid = {.n_theta_h = 45, .n_theta_d = 20, .n_phi_d = 18};
  const SeparationResult separated = separate(brdf, options, progress);
  ASSERT_TRUE(separated.report.usable) << separated.report.verdict;
  const SeparatedBrdf model(std::make_shared<const SeparatedTables>(separated.tables),
                            SeparationModel::kDiffraction);
  const SampledWavelengths lambda = [] {
    std::array<Float, kLanes> nm{}, pdf{};
    for (int i = 0; i < kLanes; ++i) nm[std::size_t(i)] = i == 0 ? 550 : Float(400 + 10 * i);
    pdf.fill(1);
    return SampledWavelengths(nm, pdf);
  }();
  constexpr double kLargestOverAlbedo = 2;  // 1.28 was seen
  for (const Material& material : {Material(brdf), Material(model)}) {
    for (const double theta : {0.0, 45.0, 80.0}) {
      TestRandom random(6);
      double largest = 0, mean = 0;
      constexpr int kSamples = 20'000;
      for (int i = 0; i < kSamples; ++i) {
        const Float lobe = random.uniform();
        const auto s =
            sample(material, direction_deg(theta, 40), {lobe, random.uniform2()}, {.lambda = lambda});
        if (!s) continue;
        largest = std::max(largest, double(s->weight[0]));
        mean += double(s->weight[0]) / kSamples;
        ASSERT_EQ(s->weight[1], 0) << "410 nm";
      }
      EXPECT_GT(mean, 100) << theta;
      EXPECT_LT(largest, kLargestOverAlbedo * mean) << theta;
    }
  }
}

using H08_NegativeInput = EveryMeasurement;

TEST_P(H08_NegativeInput, IsClampedCountedAndFittedWithoutNegatives) {
  if (!separated()) GTEST_SKIP() << "anisotropic: not separated";
  const std::size_t negative = measured().tables().negative_values;
  const std::string counted = "\"negative_values\": " + std::to_string(negative);
  EXPECT_NE(separated()->report_json.find(counted), std::string::npos) << counted;
  for (const auto* values : {&separated()->c_d, &separated()->rho_s, &separated()->s_sun,
                             &separated()->s_fresnel, &separated()->s_diffraction}) {
    EXPECT_TRUE(
        std::all_of(values->begin(), values->end(), [](float x) { return std::isfinite(x) && x >= 0; }));
  }
  // What one lobe may not take the other has: the parts are the whole.
  TestRandom random(7);
  for (const auto& [name, material] : forms()) {
    for (int i = 0; i < 500; ++i) {
      const Vec3 wo = direction_deg(89 * double(random.uniform()), 360 * double(random.uniform())),
                 wi = direction_deg(89 * double(random.uniform()), 360 * double(random.uniform()));
      const SampledSpectrum whole = evaluate(material, wo, wi, kAt).value_cos;
      const LobeValues lobes = evaluate_lobes(material, wo, wi, kAt);
      for (int lane = 0; lane < kLanes; ++lane) {
        const double size = double(lobes.diffuse[lane]) + double(lobes.fresnel[lane]) +
                            std::abs(double(lobes.diffraction[lane])) +
                            std::abs(double(lobes.residual[lane]));
        ASSERT_NEAR(double(lobes.total()[lane]), double(whole[lane]), 2e-6 * size) << name;  // 16 roundings
      }
    }
  }
}

using H09_EmptyLobes = EveryMeasurement;

TEST_P(H09_EmptyLobes, AreExactlyZeroAndNeverSampled) {
  if (!separated()) GTEST_SKIP() << "anisotropic: not separated";
  const auto is_empty = [](const std::vector<float>& v) {
    return std::all_of(v.begin(), v.end(), [](float x) { return x == 0; });
  };
  const bool no_diffuse = is_empty(separated()->c_d), no_specular = is_empty(separated()->rho_s);
  if (GetParam() == "acquired_gold") {
    EXPECT_TRUE(no_diffuse && !no_specular);
  }
  if (GetParam() == "acquired_matte") {
    EXPECT_TRUE(no_specular && !no_diffuse);
  }
  const SeparatedBrdf brdf(separated(), SeparationModel::kDiffraction);
  TestRandom random(8);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 wo = direction_deg(90 * double(random.uniform()), 360 * double(random.uniform())),
               wi = direction_deg(90 * double(random.uniform()), 360 * double(random.uniform()));
    const LobeValues lobes = brdf.evaluate_lobes(wo, wi, kAt);
    const Float u = i == 0 ? 0 : i == 1 ? 1 : random.uniform();
    const auto s = brdf.sample(wo, {u, random.uniform2()}, kAt);
    if (no_diffuse) {
      ASSERT_TRUE(lobes.diffuse.is_zero() && (!s || s->lobe == Lobe::kSpecular));
    }
    if (no_specular) {
      ASSERT_TRUE(lobes.specular().is_zero() && (!s || s->lobe == Lobe::kDiffuse));
    }
  }
}

TEST(H10_AlbedoAboveOne, PathsBetweenWallsThatMakeLightEnd) {
  // Each of up to 64 bounces gives 1.2 of the light back.
  AcquisitionOptions acquisition;
  acquisition.lambda_nm = kAcquiredWavelengthsNm;
  SilentProgress progress;
  MeasuredTables tables = acquire(Lambert{Texture(Spectrum::constant(Float(0.8)))}, acquisition, progress);
  for (float& x : tables.spectra) x *= 1.5F;
  const TemporaryFolder folder;
  measured_to_tensors(tables).write(folder / "bright.bsdf");
  SceneDesc scene = empty_scene();
  for (const ShapeDesc& wall : inward_box("wall")) scene.shapes.push_back(emitting(wall, 1));
  scene.camera.origin = {0, Float(-0.5), Float(0.1)};
  scene.integrator = {.max_depth = 64, .roulette_depth = 4};
  const auto radiance = [&](AlbedoLimit limit) {
    scene.materials = {
        {.name = "wall", .where = "", .kind = MeasuredDesc{.file = folder / "bright.bsdf", .albedo = limit}}};
    const RenderResult result = render_scene(scene, 64);
    EXPECT_EQ(result.report.invalid_samples, 0U);
    for (const float x : result.image.data) EXPECT_TRUE(std::isfinite(x));
    return estimate_y(result.image).mean;
  };
  // Kept as measured, each bounce gains; limited, none does: at most the 65 vertices' own light.
  EXPECT_GT(radiance(AlbedoLimit::kKeep), 1000);
  EXPECT_LT(radiance(AlbedoLimit::kClip), 66);
  EXPECT_LT(radiance(AlbedoLimit::kScale), 66);
}

using H11_NarrowLobes = EveryMeasurement;

TEST_P(H11_NarrowLobes, NoSampleIsAFirefly) {
  constexpr double kLargestOverAlbedo = 30;  // twice the largest seen, 14.1: fresnel at 78 degrees
  for (const auto& [name, material] : forms()) {
    for (const double theta : {0.0, 30.0, 60.0, 78.0}) {
      const Weights w = weights_of(material, theta, 1, 5000);
      EXPECT_LT(w.largest, kLargestOverAlbedo * std::max(w.mean, kLeastAlbedo)) << name << ' ' << theta;
    }
  }
}

SPECTRACE_ON_EVERY_MEASUREMENT(H08_NegativeInput);
SPECTRACE_ON_EVERY_MEASUREMENT(H09_EmptyLobes);
SPECTRACE_ON_EVERY_MEASUREMENT(H11_NarrowLobes);

}  // namespace
}  // namespace spectrace::test
