// SPDX-License-Identifier: Apache-2.0
// What must hold of AOVs in every scene, and what they tell where it is known.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/render_scenes.h"
#include "tests/support/scene_zoo.h"

namespace spectrace::test {
namespace {

class EverySceneAov : public testing::TestWithParam<NamedScene> {
 protected:
  EverySceneAov() : scene_(build_scene(GetParam().scene, progress_)) {}
  Image render_with(RenderOptions options) { return render(scene_, options, progress_).image; }

  SilentProgress progress_;
  Scene scene_;
};

std::string test_name(const testing::TestParamInfo<NamedScene>& info) {
  std::string name;
  for (char c : info.param.name) name += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  return name;
}

INSTANTIATE_TEST_SUITE_P(Zoo, EverySceneAov, testing::ValuesIn(scene_zoo()), test_name);

/// Reads one pixel by name.
class Pixel {
 public:
  Pixel(const Image& image, int x, int y) : image_(image), x_(x), y_(y) {}
  double operator()(const std::string& channel) const {
    return double(image_.at(x_, y_, image_.find_channel(channel).value()));
  }

 private:
  const Image& image_;
  int x_, y_;
};

template <typename Visit>
void for_each_pixel(const Image& image, const Visit& visit) {
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) visit(Pixel(image, x, y));
  }
}

TEST_P(EverySceneAov, ChangesNoBitOfTheBeauty) {
  const Image alone = render_with({.spp = 8, .aovs = kNoAovs});
  const Image all = render_with({.spp = 8, .aovs = kAllAovs});
  for (const char* channel : {"R", "G", "B"}) {
    const std::size_t a = alone.find_channel(channel).value(), b = all.find_channel(channel).value();
    for (int y = 0; y < all.height; ++y) {
      for (int x = 0; x < all.width; ++x) ASSERT_EQ(alone.at(x, y, a), all.at(x, y, b));
    }
  }
}

TEST_P(EverySceneAov, PartsSumToTheirWholes) {
  const Image image = render_with({.spp = 16, .aovs = kAllAovs});
  const bool has_parts = image.find_channel("specular_fresnel.R").has_value();
  for_each_pixel(image, [&](const Pixel& at) {
    for (const std::string c : {".R", ".G", ".B"}) {
      const auto near = [&](double sum, double whole, const char* what) {
        // The largest of the terms: what rounding to float is relative to.
        double scale = 0;
        for (const char* layer : {"diffuse", "specular", "emission", "background"}) {
          for (const char* channel : {".R", ".G", ".B"}) {
            scale = std::max(scale, std::abs(at(std::string(layer) + channel)));
          }
        }
        EXPECT_NEAR(sum, whole, 1e-5 * scale) << what << c;
      };
      near(at("diffuse" + c) + at("specular" + c) + at("emission" + c) + at("background" + c),
           at(c.substr(1)), "beauty");
      near(at("diffuse_direct" + c) + at("diffuse_indirect" + c), at("diffuse" + c), "diffuse");
      near(at("specular_direct" + c) + at("specular_indirect" + c), at("specular" + c), "specular");
      for (const std::string lobe : {"beauty", "diffuse", "specular"}) {
        const std::string whole = lobe == "beauty" ? c.substr(1) : lobe + c;
        near((at(lobe + "_a" + c) + at(lobe + "_b" + c)) / 2, at(whole), "halves");
        EXPECT_GE(at(lobe + "_variance" + c), 0);
      }
      if (has_parts) {
        near(at("specular_fresnel" + c) + at("specular_diffraction" + c) + at("specular_residual" + c),
             at("specular" + c), "parts of specular");
      }
    }
  });
}

TEST_P(EverySceneAov, FeaturesLieInTheirRanges) {
  const Image image = render_with({.spp = 16, .aovs = kAllAovs});
  for_each_pixel(image, [&](const Pixel& at) {
    for (const char* c : {"R", "G", "B"}) {
      for (const std::string layer : {"diffuse_albedo.", "specular_albedo.", "albedo."}) {
        EXPECT_GE(at(layer + c), 0);
        EXPECT_LE(at(layer + c), 1);
      }
    }
    EXPECT_LE(std::hypot(at("normal.X"), at("normal.Y"), at("normal.Z")), 1 + 1e-5);
    EXPECT_GE(at("depth.Z"), 0);
    EXPECT_EQ(at("samples.Z"), 16);
    for (const char* c : {"X", "Y", "Z"}) EXPECT_TRUE(std::isfinite(at(std::string("position.") + c)));
  });
}

/// A grey floor under one lamp, as seen by a camera that sees nothing else.
SceneDesc lit_floor() {
  SceneDesc scene = empty_scene();
  scene.materials = {lambert("floor", TabulatedSpectrum({400, 700}, {Float(0.2), Float(0.8)}))};
  scene.shapes = {quad({-50, -50, 0}, {100, 0, 0}, {0, 100, 0}, "floor"),
                  emitting(quad({-1, 1, 3}, {2, 0, 0}, {0, -2, 0}, "floor"), 10)};
  scene.camera = {.origin = {0, -5, 2}, .target = {0, 0, 0}, .up = {0, 0, 1}, .fov_deg = 5};
  return scene;
}

TEST(Aovs, XyzIsTheBeautyBeforeItIsRgb) {
  const RenderResult result = render_scene(lit_floor(), {.spp = 8, .aovs = {.xyz = true}});
  EXPECT_EQ(result.image.channels,
            (std::vector<std::string>{"R", "G", "B", "xyz.X", "xyz.Y", "xyz.Z", "diagnostics.invalid"}));
  EXPECT_EQ(result.report.kernel, "box, beauty only") << "it is there anyhow";
  for_each_pixel(result.image, [&](const Pixel& at) {
    const Rgb rgb = xyz_to_rgb({at("xyz.X"), at("xyz.Y"), at("xyz.Z")});
    EXPECT_GT(at("xyz.Y"), 0);
    const char* names[] = {"R", "G", "B"};
    // 1e-5: float channels, through a matrix that takes differences.
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(rgb[c], at(names[c]), 1e-5 * at("xyz.Y"));
  });
  // Under a sky of 1 at every wavelength, Y is 1.
  SceneDesc white = empty_scene();
  white.lights = {sky(1)};
  white.integrator.max_depth = 2;
  const Image sky_alone = render_scene(white, {.spp = 1024, .aovs = {.xyz = true}}).image;
  double mean = 0;
  for_each_pixel(sky_alone, [&](const Pixel& at) { mean += at("xyz.Y"); });
  EXPECT_NEAR(mean / (sky_alone.width * sky_alone.height), 1, 1e-3);
}

TEST(Aovs, VarianceIsThatOfTheMeanOfItsSamples) {
  // Renders of 1, 2, ... samples tell each sample: Σ(x - x̄)² / (n (n - 1)) of the same numbers.
  SceneDesc description = lit_floor();
  description.film = {2, 2};
  SilentProgress progress;
  const Scene scene = build_scene(description, progress);
  constexpr int kSpp = 8;
  RenderOptions options{.spp = kSpp, .aovs = kDenoiseAovs};
  const Image all = render(scene, options, progress).image;
  double sum = 0, squares = 0, last = 0;
  for (int n = 1; n <= kSpp; ++n) {  // samples 0..n-1: the n-th is what its mean adds
    options.spp = n;
    const Image some = render(scene, options, progress).image;
    const double total = Pixel(some, 0, 0)("R") * n;
    const double x = total - last;
    last = total;
    sum += x;
    squares += x * x;
  }
  const double expected = (squares - sum * sum / kSpp) / (kSpp * (kSpp - 1));
  EXPECT_NEAR(Pixel(all, 0, 0)("beauty_variance.R"), expected, 1e-4 * expected);
}

TEST(Aovs, HalvesDifferByNoiseAlone) {
  // What halves tell falls with the samples as the error of the image does, without a floor.
  SilentProgress progress;
  const Scene scene = build_scene(lit_floor(), progress);
  const auto error_at = [&](int spp) {
    RenderSession session(scene, {.spp = spp, .aovs = kDenoiseAovs});
    session.finish(progress);
    return session.film().relative_error();
  };
  const double few = error_at(64), many = error_at(1024);
  EXPECT_LT(many, few / 3) << "1/4 where samples were independent, less where they are even";
}

TEST(Aovs, HalvesShareWhateverSamplesThereAre) {
  const SceneDesc description = lit_floor();
  const auto render_with_halves = [&](int spp) {
    SilentProgress progress;
    const Scene scene = build_scene(description, progress);
    RenderSession session(scene, {.spp = spp, .aovs = kAllAovs});
    session.finish(progress);
    return std::pair(session.film().resolve(), session.film().relative_error());
  };
  EXPECT_TRUE(std::isinf(render_with_halves(1).second)) << "one sample tells nothing of its noise";
  // In half B: of a leaf that is not full its later half, else the right half of the block.
  for (const auto& [spp, in_b] : {std::pair{2, 1}, {4, 2}, {5, 2}, {7, 3}, {8, 4}, {12, 4}, {16, 8}}) {
    const auto [image, error] = render_with_halves(spp);
    EXPECT_GT(error, 0);
    EXPECT_LT(error, 1);
    for_each_pixel(image, [&, spp = spp, in_b = in_b](const Pixel& at) {
      const double a = at("beauty_a.G"), b = at("beauty_b.G"), whole = at("G");
      EXPECT_GT(b, 0) << spp;
      EXPECT_NEAR((a * (spp - in_b) + b * in_b) / spp, whole, 1e-5 * whole) << spp;
    });
  }
}

TEST(Aovs, DirectLightIsAllThereIsWithoutBounces) {
  SceneDesc description = lit_floor();
  description.integrator.max_depth = 1;
  const Image image = render_scene(description, {.spp = 16, .aovs = kAllAovs}).image;
  for_each_pixel(image, [&](const Pixel& at) {
    EXPECT_GT(at("diffuse_direct.G"), 0);
    EXPECT_NEAR(at("diffuse_indirect.G"), 0, 1e-6 * at("diffuse_direct.G"));
  });
}

TEST(Aovs, IndirectLightIsWhatBouncesAdd) {
  SceneDesc description = empty_scene();
  description.materials = {lambert("white", Float(0.8))};
  description.shapes = inward_box("white");
  description.shapes.push_back(emitting(
      quad({Float(-0.3), Float(-0.3), Float(0.99)}, {0, Float(0.6), 0}, {Float(0.6), 0, 0}, "white"), 5));
  description.camera = {.origin = {0, 0, 0}, .target = {0, 1, Float(-0.5)}, .up = {0, 0, 1}, .fov_deg = 20};
  const auto mean_of = [&](int depth, const std::string& layer) {
    description.integrator.max_depth = depth;
    return estimate_y(render_scene(description, {.spp = 256, .aovs = kAllAovs}).image, layer);
  };
  const Estimate one = mean_of(1, "diffuse"), direct = mean_of(6, "diffuse_direct");
  EXPECT_NEAR(direct.mean, one.mean, 1e-5 * one.mean) << "the same samples at the first hit";
  const Estimate all = mean_of(6, "diffuse"), indirect = mean_of(6, "diffuse_indirect");
  EXPECT_NEAR(indirect.mean, all.mean - one.mean, 1e-4 * all.mean);
  EXPECT_GT(indirect.mean, 0.5 * direct.mean) << "a white box is bright with bounces";
}

TEST(Aovs, AlbedoIsTheColourOfTheSurfaceWithoutNoise) {
  const Spectrum slope = TabulatedSpectrum({400, 700}, {Float(0.2), Float(0.8)});
  const Rgb expected = xyz_to_rgb(reflectance_to_xyz(slope));
  const Image image = render_scene(lit_floor(), {.spp = 2, .aovs = kAllAovs}).image;
  for_each_pixel(image, [&](const Pixel& at) {
    const char* names[] = {"diffuse_albedo.R", "diffuse_albedo.G", "diffuse_albedo.B"};
    // 3e-3: 32 wavelengths instead of the integral.
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(at(names[c]), expected[c], 3e-3);
    EXPECT_EQ(at("specular_albedo.R"), 0);
    EXPECT_NEAR(at("albedo_variance.G"), 0, 1e-12);
  });
}

TEST(Aovs, AlbedoOfACheckerboardIsThatOfTheCellThatIsSeen) {
  const Spectrum even = TabulatedSpectrum({400, 700}, {Float(0.2), Float(0.8)}),
                 odd = Spectrum::constant(Float(0.1));
  SceneDesc description = lit_floor();
  description.materials = {
      {.name = "floor", .where = "/materials/0", .kind = Lambert{Checkerboard{even, odd, 301, 301}}}};
  description.film = {8, 8};
  const Rgb of_even = xyz_to_rgb(reflectance_to_xyz(even));
  int evens = 0, odds = 0, mixed = 0;
  for_each_pixel(render_scene(description, {.spp = 8, .aovs = kAllAovs}).image, [&](const Pixel& at) {
    const double share = (at("diffuse_albedo.R") - 0.1) / (of_even[0] - 0.1);  // of the even cells
    evens += std::abs(share - 1) < 0.01 ? 1 : 0;
    odds += std::abs(share) < 0.01 ? 1 : 0;
    mixed += share > 0.1 && share < 0.9 ? 1 : 0;
    EXPECT_NEAR(at("diffuse_albedo.B"), 0.1 + share * (of_even[2] - 0.1), 3e-3);
  });
  EXPECT_GT(evens, 5);
  EXPECT_GT(odds, 5);
  EXPECT_GT(mixed, 1) << "pixels across the edge of a cell";
}

TEST(Aovs, AlbedoIsWhatTheSurfaceSendsBackOfAWhiteSky) {
  // A glossy ball under a sky of 1: its radiance is its albedo, lobe by lobe.
  SceneDesc description = empty_scene();
  Glossy glossy;
  glossy.reflectance = Texture(Spectrum::constant(Float(0.6)));
  glossy.ggx = {Float(0.3), Float(0.3)};
  description.materials = {{.name = "glossy", .where = "/materials/0", .kind = glossy}};
  description.shapes = {sphere({0, 0, 0}, 1, "glossy")};
  description.camera.fov_deg = 8;
  description.lights = {sky(1)};
  const Image image = render_scene(description, {.spp = 256, .aovs = kAllAovs}).image;
  for (const std::string lobe : {"diffuse", "specular"}) {
    const Estimate seen = estimate_y(image, lobe), told = estimate_y(image, lobe + "_albedo");
    // A percent: the tables' directions (256) and angles (65).
    EXPECT_NEAR(told.mean, seen.mean, 0.01 * seen.mean + 4 * seen.standard_error) << lobe;
  }
}

TEST(Aovs, FeaturesFollowMirrorsToWhatIsSeenInThem) {
  SceneDesc description = empty_scene();
  description.materials = {
      {.name = "mirror",
       .where = "/materials/0",
       .kind = SmoothConductor{{.eta = Spectrum::constant(Float(0.2)), .k = Spectrum::constant(3)}}},
      lambert("wall", Float(0.5))};
  // A mirror at 45 degrees sends the view along y up to a ceiling.
  description.shapes = {quad({-1, -1, -1}, {2, 0, 0}, {0, 2, 2}, "mirror"),
                        quad({-5, -5, 3}, {0, 10, 0}, {10, 0, 0}, "wall")};
  description.lights = {sky(1)};
  description.camera.fov_deg = 2;
  const Image image = render_scene(description, {.spp = 8, .aovs = kAllAovs}).image;
  for_each_pixel(image, [&](const Pixel& at) {
    EXPECT_NEAR(at("normal.Z"), -1, 1e-5);
    EXPECT_NEAR(at("position.Z"), 3, 1e-4);
    EXPECT_NEAR(at("depth.Z"), 8, 0.05);  // 5 to the mirror, 3 up
    EXPECT_NEAR(at("diffuse_albedo.G"), 0.5, 1e-3);
    EXPECT_EQ(at("specular.G"), 0) << "light of a wall seen in a mirror is the wall's";
  });
}

}  // namespace
}  // namespace spectrace::test
