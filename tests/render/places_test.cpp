// SPDX-License-Identifier: Apache-2.0
// Where things appear: camera, environment image, empty scenes.
#include <gtest/gtest.h>

#include "tests/support/render_scenes.h"

namespace spectrace::test {
namespace {

/// The pixel of largest luminance.
std::pair<int, int> brightest(const Image& image) {
  std::pair<int, int> best{-1, -1};
  double largest = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const double value = pixel_xyz(image, x, y)[1];
      if (value > largest) {
        largest = value;
        best = {x, y};
      }
    }
  }
  return best;
}

/// The camera of the other renderers' test scene: from -y, looking at (0, 0, 0.9), z up.
SceneDesc peer_scene(Vec3 lamp) {
  SceneDesc scene = empty_scene();
  scene.film = {33, 33};
  scene.camera = {
      .origin = {0, -5, Float(2.2)}, .target = {0, 0, Float(0.9)}, .up = {0, 0, 1}, .fov_deg = 38};
  scene.materials = {lambert("black", 0)};
  scene.shapes = {emitting(sphere(lamp, Float(0.1), "black"), 1)};
  return scene;
}

TEST(Places, PlusXIsRightAndPlusZIsUp) {
  const auto middle = brightest(render_scene(peer_scene({0, 0, Float(0.9)}), 16).image);
  EXPECT_EQ(middle, std::pair(16, 16));
  const auto right = brightest(render_scene(peer_scene({1, 0, Float(0.9)}), 16).image);
  EXPECT_GT(right.first, 20);
  EXPECT_EQ(right.second, 16);
  const auto up = brightest(render_scene(peer_scene({0, 0, Float(1.9)}), 16).image);
  EXPECT_EQ(up.first, 16);
  EXPECT_LT(up.second, 12);
}

TEST(Places, TheFieldOfViewIsOfTheShorterSide) {
  // A lamp 18 degrees up or to the right, half the field of view being 19: in the last pixels of the short
  // side.
  for (bool wide : {false, true}) {
    SceneDesc scene = empty_scene();
    scene.film = wide ? FilmDesc{80, 40} : FilmDesc{40, 80};
    scene.camera = {.origin = {0, 0, 0}, .target = {0, 1, 0}, .up = {0, 0, 1}, .fov_deg = 38};
    scene.materials = {lambert("black", 0)};
    const Float tan18 = std::tan(degrees_to_radians(18));
    scene.shapes = {emitting(sphere(wide ? Vec3{0, 1, tan18} : Vec3{tan18, 1, 0}, Float(0.01), "black"), 1)};
    const auto [x, y] = brightest(render_scene(scene, 16).image);
    EXPECT_EQ(wide ? y : 39 - x, 1) << "wide "
                                    << wide;  // (1 - tan18 / tan19) · 20 = 1.1 pixels from the edge
  }
}

TEST(Places, ACropWindowHoldsTheBitsOfTheWholeImage) {
  SceneDesc scene = empty_scene();
  scene.film = {48, 40};
  scene.materials = {lambert("grey", Float(0.5))};
  scene.shapes = {sphere({0, 0, 0}, 1, "grey")};
  scene.lights = {sky(1)};
  const Image whole = render_scene(scene, 2).image;
  scene.film.crop = CropWindow{11, 7, 21, 19};
  const Image part = render_scene(scene, 2).image;
  ASSERT_EQ(part.width, 21);
  ASSERT_EQ(part.height, 19);
  for (int y = 0; y < part.height; ++y) {
    for (int x = 0; x < part.width; ++x) {
      for (std::size_t c = 0; c < part.channels.size(); ++c) {
        ASSERT_EQ(part.at(x, y, c), whole.at(11 + x, 7 + y, c)) << x << ' ' << y << ' ' << part.channels[c];
      }
    }
  }
}

TEST(Places, AnOrthographicCameraShowsAllDistancesAtOneSize) {
  // Two emitters of radius 0.5 at distances 4 and 40, 1.5 to the left and to the right of the view.
  SceneDesc scene = empty_scene();
  scene.film = {64, 64};
  scene.camera = {.origin = {0, -10, 0},
                  .target = {0, 0, 0},
                  .up = {0, 0, 1},
                  .projection = Projection::kOrthographic,
                  .view_size = 4};
  scene.materials = {lambert("black", Float(0))};
  scene.shapes = {emitting(sphere({Float(-1.5) / 2, -6, 0}, Float(0.5), "black"), Float(1)),
                  emitting(sphere({Float(1.5) / 2, 30, 0}, Float(0.5), "black"), Float(1))};
  const Image image = render_scene(scene, 16).image;
  std::array<double, 2> area{};
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) area[x < 32 ? 0 : 1] += double(image.at(x, y, 1)) > 0.5 ? 1 : 0;
  }
  const double expected = kPi64 * sqr(0.5 * 64 / 4);  // pixels
  EXPECT_NEAR(area[0], expected, 0.05 * expected);
  EXPECT_NEAR(area[1], expected, 0.05 * expected);
}

TEST(Places, ALensShowsSharpWhatLiesAtItsFocusAndBlursTheRestByItsCone) {
  const CameraDesc lens{.origin = {0, 0, 0},
                        .target = {0, 10, 0},
                        .up = {0, 0, 1},
                        .fov_deg = 40,
                        .lens_radius = Float(0.25),
                        .focus_distance = 5};
  const Camera camera(lens, {64, 64});
  for (const Vec2 position : {Vec2{32, 32}, Vec2{3, 50}, Vec2{60, 10}}) {
    const Ray central = camera.ray(position);
    const Vec3 focus = central.origin + central.direction * (5 / central.direction.y);
    for (const Vec2 on_disk : {Vec2{1, 0}, Vec2{0, -1}, Vec2{Float(0.3), Float(0.6)}}) {
      const Ray ray = camera.ray(position, on_disk);
      const Vec3 at_focus = ray.origin + ray.direction * (5 / ray.direction.y);
      EXPECT_NEAR(length(at_focus - focus), 0, 1e-5);
      // Twice as far the cone is as wide as the lens again.
      const Vec3 beyond = ray.origin + ray.direction * (10 / ray.direction.y);
      const Vec3 central_beyond = central.direction * (10 / central.direction.y);
      EXPECT_NEAR(length(beyond - central_beyond), 0.25 * std::hypot(on_disk.x, on_disk.y), 1e-5);
    }
  }
}

TEST(Places, AnEnvironmentImageIsNotMirrored) {
  // One bright texel in the upper half, a little right of the middle: looking along +x with z up it must
  // appear up and to the right; its direction is phi = -(8.5 / 64) turns... from u = 1/2 - phi / 2π.
  Image image(64, 32, {"R", "G", "B"});
  const int texel_x = 36, texel_y = 12;
  for (int c = 0; c < 3; ++c) image.at(texel_x, texel_y, c) = 100;
  const auto file = std::filesystem::path(testing::TempDir()) / "places_sky.exr";
  write_exr(file, image, {});
  SceneDesc scene = empty_scene();
  scene.film = {41, 41};
  scene.camera = {.origin = {0, 0, 0}, .target = {1, 0, 0}, .up = {0, 0, 1}, .fov_deg = 90};
  scene.lights = {EnvironmentDesc{.file = file}};
  const auto [x, y] = brightest(render_scene(scene, 64).image);
  const double phi = (texel_x + 0.5 - 32) / 64 * 360, elevation = (16 - texel_y - 0.5) / 32 * 180;
  const double right = std::tan(phi * kPi / 180),
               up = std::tan(elevation * kPi / 180) / std::cos(phi * kPi / 180);
  EXPECT_NEAR(x, 20.5 * (1 + right) - 0.5, 1);
  EXPECT_NEAR(y, 20.5 * (1 - up) - 0.5, 1);
  // Turned by 90 degrees about z, what lay along +x lies along +y.
  std::get<EnvironmentDesc>(scene.lights[0]).to_world = rotation_z(90);
  scene.camera.target = {0, 1, 0};
  EXPECT_EQ(brightest(render_scene(scene, 64).image), std::pair(x, y));
}

TEST(Places, AWhiteFactorLeavesAnEnvironmentImageAsItIs) {
  Image image(8, 4, {"R", "G", "B"});
  std::fill(image.data.begin(), image.data.end(), 1.0F);
  const auto folder = std::filesystem::path(testing::TempDir());
  write_exr(folder / "places_white.exr", image, {});
  const auto mean_of = [&](const std::string& radiance) {
    const std::string text = R"({"camera": {"type": "pinhole", "origin": [0, -5, 0],
      "target": [0, 0, 0], "up": [0, 0, 1]}, "film": {"width": 8, "height": 8}, "materials": [], "shapes": [],
      "lights": [{"type": "environment", "file": "places_white.exr")" +
                             radiance + "}]}";
    const Image rendered = render_scene(parse_scene(text, folder / "places_white.json"), 256).image;
    std::array<double, 3> mean{};
    for (int y = 0; y < 8; ++y) {
      for (int x = 0; x < 8; ++x) {
        for (std::size_t c = 0; c < 3; ++c) mean[c] += double(rendered.at(x, y, c)) / 64;
      }
    }
    return mean;
  };
  const auto alone = mean_of(""), white = mean_of(R"(, "radiance": {"rgb": [1, 1, 1]})"),
             tinted = mean_of(R"(, "radiance": {"rgb": [0.25, 0.5, 1]})");
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(white[c], alone[c], 1e-4 * alone[c]);  // S(0) = 1/2 times 2
    // The colour itself, as a reflectance of that colour would show it: the same wavelengths are drawn.
    EXPECT_NEAR(tinted[c], (std::array{0.25, 0.5, 1.0})[c], 0.02);
  }
}

TEST(Places, ABrightTexelLightsTheSideItShinesOn) {
  // The same texel as a lamp: shadows and pictures must agree on where it is.
  Image image(64, 32, {"R", "G", "B"});
  for (int c = 0; c < 3; ++c) image.at(16, 16, c) = 100;  // u = 1/4: phi = 90 degrees, +y
  const auto file = std::filesystem::path(testing::TempDir()) / "places_lamp.exr";
  write_exr(file, image, {});
  SceneDesc scene = empty_scene();
  scene.materials = {lambert("grey", Float(0.5))};
  scene.shapes = {sphere({0, 0, 0}, 1, "grey")};
  scene.lights = {EnvironmentDesc{.file = file}};
  scene.camera.fov_deg = 2;
  const auto lit_from = [&](Vec3 from) {
    scene.camera.origin = from;
    return estimate_y(render_scene(scene, 256).image, "diffuse").mean;
  };
  const double front = lit_from({0, 5, 0});
  EXPECT_GT(front, 0);
  EXPECT_EQ(lit_from({0, -5, 0}), 0);
  EXPECT_LT(lit_from({5, 0, 0}), 0.2 * front);
}

TEST(Places, AnEmptySceneShowsItsBackground) {
  EXPECT_EQ(estimate_y(render_scene(empty_scene(), 4).image).mean, 0);
  SceneDesc scene = empty_scene();
  scene.lights = {sky(2)};
  const Image image = render_scene(scene, 256).image;
  const Estimate y = estimate_y(image, "background");
  EXPECT_NEAR(y.mean, 2, 4 * y.standard_error);
  EXPECT_EQ(estimate_y(image).mean, y.mean);
}

}  // namespace
}  // namespace spectrace::test
