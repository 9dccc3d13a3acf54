// SPDX-License-Identifier: Apache-2.0
// Images of spectra, as textures and as light: what they show is what the spectra say.
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/support/render_scenes.h"
#include "tests/support/temporary_folder.h"

namespace spectrace::test {
namespace {

// A narrow line on a slope: no colour in R, G, B could stand for it.
const std::vector<Float> kNm{360, 500, 510, 520, 700, 830};
const std::vector<Float> kValues{Float(0.1), Float(0.2), 1, Float(0.2), Float(0.5), Float(0.5)};

Image uniform_image(const std::string& prefix, int width, int height, float scale) {
  std::vector<std::string> channels;
  for (Float nm : kNm) channels.push_back(prefix + std::to_string(int(nm)) + ",0nm");
  Image image(width, height, channels);
  for (std::size_t i = 0; i < image.data.size(); ++i) image.data[i] = scale * float(kValues[i % kNm.size()]);
  return image;
}

// Of wavelengths in single precision, and of sums by 1 nm beside the statistical error: 5x the largest seen.
constexpr double kRounding = 1e-4;

void expect_xyz(const Image& image, const std::string& layer, const Xyz& expected) {
  for (int c = 0; c < 3; ++c) {
    const Estimate e = estimate_xyz(image, layer, c);
    EXPECT_NEAR(e.mean, expected[c], 4 * e.standard_error + kRounding * expected[c]) << layer << ' ' << c;
    EXPECT_LT(e.standard_error, 0.02 * expected[c]);
  }
}

TEST(SpectralImages, SkiesShowTheirSpectra) {
  const TemporaryFolder folder;
  write_exr(folder / "sky.exr", uniform_image("S0.", 8, 4, 3), {{"emissiveUnits", "W.m^-2.sr^-1"}});
  SceneDesc scene = empty_scene();
  scene.lights = {EnvironmentDesc{.file = folder / "sky.exr"}};
  const Spectrum sky = TabulatedSpectrum(kNm, kValues);
  expect_xyz(render_scene(scene, 1024).image, "background", spectrum_to_xyz(sky.scaled(3)));
  // As light: a floor of albedo 1/2.
  scene.materials = {lambert("floor", Float(0.5))};
  scene.shapes = {quad({-10, -10, 0}, {20, 0, 0}, {0, 20, 0}, "floor")};
  look_at_point(scene, {4, 0, 2}, {0, 0, 0});
  expect_xyz(render_scene(scene, 1024).image, "diffuse", spectrum_to_xyz(sky.scaled(Float(1.5))));
}

TEST(SpectralImages, BrightTexelsAreFoundByTheirLuminance) {
  const TemporaryFolder folder;
  Image image = uniform_image("S0.", 32, 16, 0.01F);
  for (std::size_t c = 0; c < kNm.size(); ++c) image.at(8, 4, c) = 1000;
  write_exr(folder / "sun.exr", image, {});
  const Environment sky(read_image(folder / "sun.exr"), "sun.exr", Spectrum::constant(1), {});
  // Nearly all of the light comes from that texel and its bilinear surroundings.
  int bright = 0;
  const SampledWavelengths lambda = WavelengthDistribution::uniform({}).sample(Float(0.5));
  for (int i = 0; i < 32; ++i) {
    for (int j = 0; j < 32; ++j) {
      const auto s = sky.sample({(Float(i) + Float(0.5)) / 32, (Float(j) + Float(0.5)) / 32});
      ASSERT_TRUE(s);
      bright += sky.radiance(s->wi, lambda)[0] > 1 ? 1 : 0;
    }
  }
  EXPECT_GT(bright, 1000);
}

TEST(SpectralImages, SkiesRefuseWhatIsNoRadiance) {
  const TemporaryFolder folder;
  Image image = uniform_image("S0.", 4, 2, 1);
  image.at(2, 1, 3) = -1;
  try {
    (void)Environment(image, "sky.exr", Spectrum::constant(1), {});
    ADD_FAILURE();
  } catch (const InputError& e) {
    EXPECT_EQ(e.diagnostics()[0].text(),
              "sky.exr:pixel (2, 1): radiance must be finite and not negative, got -1");
  }
  write_exr(folder / "lux.exr", uniform_image("S0.", 4, 2, 1), {{"emissiveUnits", "lux"}});
  SceneDesc scene = empty_scene();
  scene.lights = {EnvironmentDesc{.file = folder / "lux.exr"}};
  EXPECT_THROW(render_scene(scene, 1), InputError);
}

TEST(SpectralImages, TexturesReflectTheirSpectra) {
  const TemporaryFolder folder;
  write_exr(folder / "t.exr", uniform_image("T.", 4, 4, 1), {});
  SceneDesc scene = empty_scene();
  scene.shapes = {quad({-10, -10, 0}, {20, 0, 0}, {0, 20, 0}, "floor")};
  scene.lights = {sky(2)};
  look_at_point(scene, {4, 0, 2}, {Float(0.3), 0, 0});
  scene.materials = {{.name = "floor", .where = "", .kind = Lambert{image_texture(folder / "t.exr")}}};
  const Spectrum reflectance = TabulatedSpectrum(kNm, kValues);
  expect_xyz(render_scene(scene, 1024).image, "diffuse", spectrum_to_xyz(reflectance.scaled(2)));
}

}  // namespace
}  // namespace spectrace::test
