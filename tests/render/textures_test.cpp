// SPDX-License-Identifier: Apache-2.0
// Image textures in pictures: what is far is averaged, what is near is bilinear, and nothing else changes.
#include <gtest/gtest.h>

#include <cmath>

#include "core/image/texture_cache.h"
#include "tests/support/render_scenes.h"
#include "tests/support/temporary_folder.h"

namespace spectrace::test {
namespace {

constexpr float kDark = 0.1F, kBright = 0.7F;
constexpr int kChecks = 128, kTexelsOfCheck = 8;

Image checks() {
  constexpr int kSide = kChecks * kTexelsOfCheck;
  Image image(kSide, kSide, {"R", "G", "B"});
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      // v runs upwards: check (0, 0) is at the lower left.
      const int check = x / kTexelsOfCheck + (kSide - 1 - y) / kTexelsOfCheck;
      for (std::size_t c = 0; c < 3; ++c) image.at(x, y, c) = check % 2 == 0 ? kDark : kBright;
    }
  }
  return image;
}

/// A plain seen at a slant under a white sky: the farthest pixels see hundreds of checks each.
SceneDesc plain(Texture texture) {
  SceneDesc scene = empty_scene();
  scene.film = {24, 24};
  scene.camera.origin = {0, 0, 2};
  scene.camera.target = {0, 20, 0};
  scene.camera.fov_deg = 8;
  scene.integrator.max_depth = 1;
  scene.materials = {{.name = "floor", .where = "", .kind = Lambert{std::move(texture)}}};
  scene.shapes = {quad({-32, 0, 0}, {64, 0, 0}, {0, 64, 0}, "floor")};
  scene.lights = {sky(1)};
  return scene;
}

constexpr int kSeeds = 16;

struct Pictures {
  double mean = 0, variance = 0;  // over pixels; of a pixel, over seeds
  double pixels = 0;
};

Pictures over_seeds(const SceneDesc& scene, int spp) {
  SilentProgress progress;
  const Scene built = build_scene(scene, progress);
  const std::size_t pixels = std::size_t(scene.film.width) * std::size_t(scene.film.height);
  std::vector<double> sums(pixels), squares(pixels);
  for (int seed = 0; seed < kSeeds; ++seed) {
    const Image image = render(built, {.spp = spp, .seed = std::uint64_t(seed)}, progress).image;
    for (std::size_t i = 0; i < pixels; ++i) {
      const double y = pixel_xyz(image, int(i) % image.width, int(i) / image.width)[1];
      sums[i] += y / kSeeds;
      squares[i] += y * y / kSeeds;
    }
  }
  Pictures p{.pixels = double(pixels)};
  for (std::size_t i = 0; i < pixels; ++i) {
    p.mean += sums[i] / double(pixels);
    p.variance += (squares[i] - sums[i] * sums[i]) / double(pixels);
  }
  return p;
}

TEST(Textures, FarChecksAreQuieterAsAnImageAndOfTheSameMean) {
  const Spectrum dark = Spectrum::constant(kDark), bright = Spectrum::constant(kBright);
  const SceneDesc points = plain(Checkerboard{dark, bright, kChecks, kChecks});
  const SceneDesc image = plain(BitmapTexture(checks()));
  for (const int spp : {1, 4}) {
    const Pictures p = over_seeds(points, spp), f = over_seeds(image, spp);
    EXPECT_LT(f.variance, p.variance / 10) << "21 and 34 times lower when this was written";
    const double standard_error = std::sqrt((p.variance + f.variance) / (p.pixels * kSeeds));
    EXPECT_NEAR(f.mean, p.mean, 4 * standard_error);
    EXPECT_LT(standard_error, 0.01 * p.mean);
  }
}

TEST(Textures, WhatIsNearIsBilinear) {
  // Beside the border of two checks, a quarter of the way from the centre of the last dark texel to that of
  // the first bright one; all pixels see this point.
  SceneDesc scene = plain(BitmapTexture(checks()));
  const double texel = 64.0 / (kChecks * kTexelsOfCheck);
  const auto x = Float(-32 + (kTexelsOfCheck - 0.25) * texel), y = Float(4 * texel);
  look_at_point(scene, {x, y + Float(0.5), 1}, {x, y, 0});
  const Estimate e = estimate_y(render_scene(scene, 256).image);
  const double expected = kDark + 0.25 * double(kBright - kDark);
  EXPECT_NEAR(e.mean, expected, 4 * e.standard_error + 2e-3 * expected);  // 2e-3: the uplift of colours
  EXPECT_LT(e.standard_error, 0.01 * expected);
}

TEST(Textures, FlatMirrorsShowThemAsSharpAsTheyAre) {
  // Straight down from height 9, and from height 1 by way of a mirror at height 5: the same length of the
  // path.
  const auto relative_variance = [](SceneDesc scene) {
    scene.film = {16, 16};
    // Beneath the mirror; and no noise but the texture's.
    scene.lights = {DirectionalLightDesc{normalize({0, 4, -1}), Spectrum::constant(9)}};
    scene.camera.fov_deg = 60;
    scene.camera.up = {0, 1, 0};
    const Image image = render_scene(scene, 1).image;
    double sum = 0, squares = 0;
    for (int i = 0; i < 256; ++i) {
      const double y = pixel_xyz(image, i % 16, i / 16, "")[1];
      sum += y / 256;
      squares += y * y / 256;
    }
    return squares / (sum * sum) - 1;
  };
  SceneDesc direct = plain(BitmapTexture(checks()));
  direct.camera.origin = {0, 32, 9};
  direct.camera.target = {0, 32, 0};
  SceneDesc mirrored = plain(BitmapTexture(checks()));
  mirrored.camera.origin = {0, 32, 1};
  mirrored.camera.target = {0, 32, 5};
  mirrored.integrator.max_depth = 2;
  mirrored.materials.push_back(
      {.name = "mirror",
       .where = "",
       .kind = SmoothConductor{{.eta = Spectrum::constant(Float(0.2)), .k = Spectrum::constant(3)}}});
  mirrored.shapes.push_back(quad({-10, 22, 5}, {0, 20, 0}, {20, 0, 0}, "mirror"));
  const double a = relative_variance(direct), b = relative_variance(mirrored);
  EXPECT_GT(b, a / Float(1.5));
  EXPECT_LT(b, a * Float(1.5)) << "a cone that began anew at the mirror would show twice the variance";
}

}  // namespace
}  // namespace spectrace::test
