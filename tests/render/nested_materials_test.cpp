// SPDX-License-Identifier: Apache-2.0
// Two-sided, mixed, masked and normal-mapped surfaces, by radiances known in closed form.
#include <gtest/gtest.h>

#include <cmath>

#include "core/math/math.h"
#include "tests/support/render_scenes.h"

namespace spectrace::test {
namespace {

// About 30 comparisons at alpha 0.01 (Šidák) ask for 3.6 standard errors.
constexpr double kSigmas = 4;
constexpr double kRounding = 1e-4;  // float geometry seen through a camera of 1e-3 degrees

void expect_y(const SceneDesc& scene, double expected, int spp, const std::string& layer = "") {
  const Estimate y = estimate_y(render_scene(scene, spp).image, layer);
  EXPECT_NEAR(y.mean, expected, kSigmas * y.standard_error + kRounding * std::abs(expected)) << layer;
  EXPECT_LE(kSigmas * y.standard_error, 0.02 * std::abs(expected)) << "cannot tell " << layer;
}

MaterialDesc made_of(const std::string& name, decltype(MaterialDesc::kind) kind) {
  return {.name = name, .where = "", .kind = std::move(kind)};
}
MaterialDesc masked(const std::string& name, Float albedo, ScalarTexture opacity) {
  return made_of(name, MaskedDesc{.parts = {lambert("", albedo)}, .opacity = std::move(opacity)});
}

/// So wide that what comes in beneath it is nothing: 2.5e-7 of a sky's irradiance.
ShapeDesc pane_at(Float z) { return quad({-2000, -2000, z}, {4000, 0, 0}, {0, 4000, 0}, "pane"); }

/// A floor of albedo 1/2, seen at the origin from the side, and a pane over it at height 1.
SceneDesc floor_under_pane(MaterialDesc pane) {
  SceneDesc scene = empty_scene();
  scene.materials = {lambert("floor", Float(0.5)), lambert("black", 0), std::move(pane)};
  scene.shapes = {quad({-10, -10, 0}, {20, 0, 0}, {0, 20, 0}, "floor"), pane_at(1)};
  look_at_point(scene, {2, 0, Float(0.5)}, {0, 0, 0});
  return scene;
}

TEST(Mask, DeltaLightsShineThroughHoles) {
  SceneDesc scene = floor_under_pane(masked("pane", 0, Float(0.25)));
  scene.lights = {DirectionalLightDesc{normalize({0, 4, -3}), Spectrum::constant(20)}};
  expect_y(scene, 0.75 * 0.5 / kPi64 * 20 * 3 / 5, 64);
  scene.lights = {PointLightDesc{{0, 4, 3}, Spectrum::constant(20)}};
  expect_y(scene, 0.75 * 0.5 / kPi64 * 20 * (3.0 / 5) / 25, 64);
  // A second pane multiplies.
  scene.shapes.push_back(pane_at(2));
  expect_y(scene, 0.75 * 0.75 * 0.5 / kPi64 * 20 * (3.0 / 5) / 25, 64);
}

TEST(Mask, HolesOfATextureAreWhereItSays) {
  // Even checks are holes; (0, 0) is lit through the pane's point (0, -4/3, 1): uv (0.5, 0.4997).
  for (const Float even : {Float(0), Float(1)}) {
    SceneDesc scene = floor_under_pane(masked("pane", 0, ScalarCheckerboard{even, 1 - even, {1, 10}}));
    scene.lights = {DirectionalLightDesc{normalize({0, 4, -3}), Spectrum::constant(20)}};
    const double lit = 0.5 / kPi64 * 20 * 3 / 5;
    if (even == 0) {
      expect_y(scene, lit, 16);  // v lies in check 4
    } else {
      EXPECT_EQ(estimate_y(render_scene(scene, 16).image).mean, 0);
    }
  }
}

TEST(Mask, LightsAndChanceFindTheSameThroughHoles) {
  for (const bool next_event : {true, false}) {
    SceneDesc scene = floor_under_pane(masked("pane", 0, Float(0.25)));
    scene.shapes.push_back(emitting(sphere({0, 0, 3}, 1, "black"), 7));
    scene.lights = {sky(3)};
    scene.integrator.next_event = next_event;
    // A black pane: what shines through is 3/4 of sky and sphere (1/9 of the sky's irradiance is the
    // sphere's).
    expect_y(scene, 0.75 * 0.5 * (3 * 8 / 9.0 + 7 / 9.0), 4096);
  }
}

TEST(Mask, HolesAreNoBounce) {
  // Direct light alone reaches the floor through two panes and the camera through two more.
  SceneDesc scene = floor_under_pane(masked("pane", 0, Float(0.5)));
  scene.shapes.push_back(pane_at(2));
  look_at_point(scene, {1, 0, 5}, {0, 0, 0});
  scene.lights = {sky(4)};
  scene.integrator = {.max_depth = 1, .roulette_depth = 1};
  for (const bool next_event : {true, false}) {
    scene.integrator.next_event = next_event;
    expect_y(scene, 0.5 * 4 / 16.0, 16384);
  }
}

TEST(Mask, FurnaceOfAHalfMaskedBodyIsWhite) {
  SceneDesc scene = empty_scene();
  scene.materials = {masked("ball", 1, Float(0.5))};
  scene.shapes = {sphere({0, 0, 0}, 1, "ball")};
  scene.lights = {sky(1)};
  scene.camera.fov_deg = 10;
  scene.integrator.max_depth = 64;
  expect_y(scene, 1, 4096);
}

TEST(Mask, WhatIsSeenThroughAHoleStaysInItsLayer) {
  SceneDesc scene = empty_scene();
  scene.materials = {masked("pane", 0, Float(0)), lambert("black", 0)};
  scene.shapes = {quad({-9, -2, -9}, {18, 0, 0}, {0, 0, 18}, "pane"),
                  emitting(sphere({0, 0, 0}, 1, "black"), 5)};
  look_at_point(scene, {0, -5, 0}, {0, 0, 0});
  expect_y(scene, 5, 16, "emission");
  scene.shapes.pop_back();
  scene.lights = {sky(2)};
  expect_y(scene, 2, 16, "background");
}

TEST(TwoSided, EachSideHasItsMaterial) {
  SceneDesc scene = empty_scene();
  scene.materials = {
      made_of("card", TwoSidedDesc{.parts = {lambert("", Float(0.8)), lambert("", Float(0.3))}})};
  scene.shapes = {quad({-9, -9, 0}, {18, 0, 0}, {0, 18, 0}, "card")};  // its front looks up
  scene.lights = {sky(1)};
  look_at_point(scene, {1, 0, 3}, {0, 0, 0});
  expect_y(scene, 0.8, 1024);
  look_at_point(scene, {1, 0, -3}, {0, 0, 0});
  expect_y(scene, 0.3, 1024);
}

TEST(Mix, IsTheMeanOfItsParts) {
  SceneDesc scene = empty_scene();
  scene.materials = {made_of(
      "mix", MixDesc{.parts = {lambert("", Float(0.2)), lambert("", Float(0.8))}, .weight = Float(0.25)})};
  scene.shapes = {quad({-9, -9, 0}, {18, 0, 0}, {0, 18, 0}, "mix")};
  scene.lights = {sky(1)};
  look_at_point(scene, {1, 0, 3}, {0, 0, 0});
  expect_y(scene, 0.75 * 0.2 + 0.25 * 0.8, 1024);
}

/// A quad on which u grows along +x and v along +y, its normals bent towards +x and a little towards +y.
SceneDesc bent_quad() {
  Image image(1, 1, {"R", "G", "B"});
  image.data = {0.8F, 0.56F, 0.5F + 0.5F * 0.79F};  // (0.6, 0.12, 0.79)
  SceneDesc scene = empty_scene();
  scene.materials = {made_of("bumps", NormalMappedDesc{.parts = {lambert("", Float(0.5))},
                                                       .normals = NormalTexture(CachedImage(image))})};
  scene.shapes = {quad({-9, -9, 0}, {18, 0, 0}, {0, 18, 0}, "bumps")};
  return scene;
}

TEST(NormalMap, BendsTowardsUAndV) {
  const Vec3 n = normalize({Float(0.6), Float(0.12), Float(0.79)});
  for (const Vec3 to_light :
       {normalize({Float(0.5), Float(0.3), 1}), normalize({Float(-0.3), Float(0.8), 1})}) {
    SceneDesc scene = bent_quad();
    scene.lights = {DirectionalLightDesc{-to_light, Spectrum::constant(2)}};
    look_at_point(scene, {Float(0.5), 0, 3}, {0, 0, 0});
    expect_y(scene, 0.5 / kPi64 * 2 * dot(n, to_light), 16);
    // From behind, the dents are where the bumps were.
    scene.lights = {DirectionalLightDesc{to_light, Spectrum::constant(2)}};
    look_at_point(scene, {Float(-0.5), 0, -3}, {0, 0, 0});
    expect_y(scene, 0.5 / kPi64 * 2 * dot(n, to_light), 16);
  }
}

TEST(NormalMap, FollowsTextureCoordinatesThroughAMirroringTransform) {
  // Mirrored in x: u grows along -x, so that the bump does, too.
  SceneDesc scene = bent_quad();
  scene.shapes[0].to_world = scaling({-1, 1, 1});
  const Vec3 n = normalize({Float(-0.6), Float(0.12), Float(0.79)}),
             to_light = normalize({Float(0.5), Float(0.9), 1});
  for (const bool instanced : {false, true}) {
    if (instanced) {
      ShapeDesc shape = scene.shapes[0];
      shape.to_world = {};
      scene.groups = {{"group", {shape}}};
      scene.shapes = {{.where = "", .kind = InstanceDesc{"group"}, .to_world = scaling({-1, 1, 1})}};
    }
    // Whichever side is the front now, the light and the camera stand on the same.
    for (const Float side : {Float(1), Float(-1)}) {
      SceneDesc lit = scene;
      lit.lights = {DirectionalLightDesc{to_light * -side, Spectrum::constant(2)}};
      look_at_point(lit, {Float(0.5), 0, 3 * side}, {0, 0, 0});
      const Image image = render_scene(lit, 16).image;
      const double front = 0.5 / kPi64 * 2 * dot(n, to_light);
      // Lit from below, the bump that looks up-left is a dent that looks down-right of it: the same cosine.
      EXPECT_NEAR(estimate_y(image).mean, front, kRounding) << instanced << " " << side;
    }
  }
}

}  // namespace
}  // namespace spectrace::test
