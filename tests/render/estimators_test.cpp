// SPDX-License-Identifier: Apache-2.0
// Different ways to the same mean: light sampling on and off, instances and copies, importance and chance.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/render_scenes.h"

namespace spectrace::test {
namespace {

// Comparisons of two independent means; 12 of them at alpha 0.01 (Šidák) ask for 3.4 standard errors.
constexpr double kSigmas = 4;

void expect_same_mean(const Estimate& a, const Estimate& b, const std::string& what) {
  const double error = std::hypot(a.standard_error, b.standard_error);
  EXPECT_NEAR(a.mean, b.mean, kSigmas * error + 1e-6 * std::abs(a.mean)) << what;
  EXPECT_LT(error, 0.02 * std::abs(a.mean)) << what << ": cannot tell a difference";
}

SceneDesc corner_scene(MaterialDesc floor) {
  SceneDesc scene = empty_scene();
  scene.shapes = {quad({-10, -10, 0}, {20, 0, 0}, {0, 20, 0}, floor.name)};
  scene.materials = {std::move(floor), lambert("black", 0)};
  look_at_point(scene, {3, 0, 3}, {0, 0, 0});
  scene.integrator.max_depth = 4;
  return scene;
}

std::vector<MaterialDesc> floors() {
  return {lambert("floor", Float(0.5)),
          {.name = "floor",
           .where = "",
           .kind = RoughConductor{.fresnel = {.eta = Spectrum::constant(1), .k = Spectrum::constant(3)},
                                  .ggx = {Float(0.3), Float(0.3)}}},
          {.name = "floor",
           .where = "",
           .kind = Glossy{.reflectance = Texture(Spectrum::constant(Float(0.5))),
                          .fresnel = SchlickFresnel{Spectrum::constant(Float(0.3))},
                          .ggx = {Float(0.4), Float(0.4)}}},
          {.name = "floor",
           .where = "",
           .kind = PlasticDesc{Spectrum::constant(Float(0.5)), Spectrum::constant(Float(1.5)), 0}},
          {.name = "floor",
           .where = "",
           .kind = PlasticDesc{Spectrum::constant(Float(0.5)), Spectrum::constant(Float(1.5)), Float(0.3)}}};
}

void expect_light_sampling_unbiased(SceneDesc scene, const std::string& what) {
  scene.integrator.next_event = true;
  const Image with = render_scene(scene, {.spp = 4096, .seed = 1}).image;
  scene.integrator.next_event = false;
  const Image without = render_scene(scene, {.spp = 16384, .seed = 2}).image;
  for (const char* layer : {"", "diffuse", "specular"}) {
    const Estimate a = estimate_y(with, layer), b = estimate_y(without, layer);
    if (*layer != '\0' && a.mean == 0 && b.mean == 0) continue;  // a lobe the material does not have
    expect_same_mean(a, b, what + " layer " + layer);
  }
}

TEST(Estimators, LightSamplingKeepsTheMeanOfAreaLights) {
  for (MaterialDesc& floor : floors()) {
    SceneDesc scene = corner_scene(floor);
    scene.shapes.push_back(emitting(sphere({-2, Float(0.5), 3}, Float(1.2), "black"), 5));
    scene.shapes.push_back(emitting(quad({-1, 3, Float(0.2)}, {2, 0, 0}, {0, 0, 2}, "black"), 3));
    expect_light_sampling_unbiased(scene, "sphere and quad");
  }
}

TEST(Estimators, LightSamplingKeepsTheMeanInsideASphereOfTriangles) {
  // Emitting triangles all around but below, seen from inside: fronts face inwards by the mirroring scale...
  // of a mesh whose winding is turned.
  for (MaterialDesc& floor : floors()) {
    SceneDesc scene = corner_scene(floor);
    MeshDesc dome = polyhedral_sphere(7, 10);
    for (auto& triangle : dome.triangles) std::swap(triangle[1], triangle[2]);
    scene.shapes.push_back(
        emitting(moved({.where = "", .kind = dome, .material = "black"}, scaling({5, 5, 5})), 2));
    scene.camera.origin = {2, 0, 2};
    expect_light_sampling_unbiased(scene, "dome");
  }
}

TEST(Estimators, LightSamplingKeepsTheMeanThroughRoughGlass) {
  // A pane of one interface, lit from either side; dispersing, so that lanes compete with each other as well.
  const SellmeierSpectrum flint{.b = {Float(1.73759695), Float(0.313747346), Float(1.89878101)},
                                .c_um2 = {Float(0.013188707), Float(0.0623068142), Float(155.23629)}};
  for (const bool from_above : {true, false}) {
    const Float alpha = from_above ? Float(0.1) : Float(0.4), z = from_above ? Float(3) : Float(-3);
    SceneDesc scene =
        corner_scene({.name = "pane", .where = "", .kind = RoughDielectric(flint, {alpha, alpha})});
    look_at_point(scene, {1, 0, z}, {0, 0, 0});
    // One that is seen by reflection, one by refraction: both in the lobes, so that either way finds them.
    scene.shapes.push_back(emitting(sphere({-1, Float(0.5), z}, Float(0.8), "black"), 5));
    scene.shapes.push_back(emitting(sphere({Float(-0.5), 0, -z}, Float(0.8), "black"), 3));
    expect_light_sampling_unbiased(scene, from_above ? "from above" : "from below");
  }
}

TEST(Estimators, LightSamplingKeepsTheMeanOfManyLights) {
  // Lamps on both sides of the floor, which counts only where it is a pane of glass: chosen by estimates, and
  // found by chance too.
  std::vector<MaterialDesc> materials = floors();
  materials.push_back({.name = "pane",
                       .where = "",
                       .kind = RoughDielectric(Spectrum::constant(Float(1.5)), {Float(0.3), Float(0.3)})});
  for (MaterialDesc& floor : materials) {
    SceneDesc scene = corner_scene(floor);
    look_at_point(scene, {3, 0, 1},
                  {0, 0, 0});  // lobes reach lamps that stand low, which estimates count less
    for (int i = 0; i < 40; ++i) {
      const Float phi = Float(0.4) + Float(i) * Float(0.14),
                  z = (i % 4 == 0 ? -1 : 1) * (Float(0.5) + Float(i % 3));
      const Vec3 at{Float(2.5) * std::cos(phi), Float(2.5) * std::sin(phi), z};
      const Float radiance = Float(1 + i % 5);
      scene.shapes.push_back(
          i % 2 == 0
              ? emitting(sphere(at, Float(0.4), "black"), radiance)
              : emitting(quad(at, cross(at, {0, 0, Float(0.2)}), {0, 0, Float(0.5)}, "black"), radiance));
    }
    scene.lights = {sky(Float(0.2))};
    expect_light_sampling_unbiased(scene, "many lights over " + floor.name);
  }
}

/// A sky with a bright patch, dim elsewhere.
std::filesystem::path write_sky(const std::string& name) {
  Image image(32, 16, {"R", "G", "B"});
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 32; ++x) {
      const bool bright = x >= 10 && x < 13 && y >= 4 && y < 6;
      for (int c = 0; c < 3; ++c) image.at(x, y, c) = bright ? 30.F : 0.2F + 0.1F * float(c);
    }
  }
  const auto file = std::filesystem::path(testing::TempDir()) / name;
  write_exr(file, image, {});
  return file;
}

TEST(Estimators, LightSamplingKeepsTheMeanOfASky) {
  const auto file = write_sky("estimators_sky.exr");
  for (MaterialDesc& floor : floors()) {
    SceneDesc scene = corner_scene(floor);
    scene.lights = {EnvironmentDesc{.file = file, .to_world = rotation_z(75)}};
    expect_light_sampling_unbiased(scene, "sky");
  }
}

TEST(Estimators, InstancesLookLikeTransformedCopies) {
  SceneDesc copies = empty_scene();
  copies.film = {32, 32};
  copies.materials = {lambert("grey", Float(0.7))};
  // One delta light, one bounce: no random direction, which would turn with the (arbitrary) tangents.
  copies.lights = {DirectionalLightDesc{normalize({1, 2, -3}), Spectrum::constant(2)}};
  copies.integrator.max_depth = 1;
  // A shape beside the instances, of another material: groups come first in the shape list, it does not.
  copies.materials.push_back(lambert("dark", Float(0.1)));
  copies.shapes = {quad({-3, -3, -2}, {6, 0, 0}, {0, 6, 0}, "dark")};
  SceneDesc instances = copies;
  const std::vector<ShapeDesc> parts{
      sphere({Float(0.5), 0, 0}, Float(0.4), "grey"),
      quad({-1, -1, -1}, {2, 0, 0}, {0, 2, Float(0.5)}, "grey"),
      moved({.where = "", .kind = polyhedral_sphere(6, 8), .material = "grey"},
            translation({Float(-0.5), 0, 0}).compose(scaling({Float(0.4), Float(0.4), Float(0.4)})))};
  instances.groups = {{"parts", parts}};
  // One of them mirrored: uniform scale, so that the copies' spheres stay spheres.
  for (const Transform& t :
       {translation({1, 0, Float(0.7)}).compose(rotation_z(30)),
        translation({-1, 0, Float(-0.5)}).compose(scaling({Float(-0.8), Float(0.8), Float(0.8)}))}) {
    instances.shapes.push_back(moved({.where = "", .kind = InstanceDesc{"parts"}}, t));
    for (const ShapeDesc& part : parts) copies.shapes.push_back(moved(part, t.compose(part.to_world)));
  }
  const Image a = render_scene(copies, 64).image, b = render_scene(instances, 64).image;
  // The same random numbers and the same surfaces: only rounding (an edge met or missed) may differ.
  double difference = 0, sum = 0;
  for (std::size_t i = 0; i < a.data.size(); ++i) {
    difference += std::abs(double(a.data[i]) - b.data[i]);
    sum += std::abs(a.data[i]);
  }
  EXPECT_GT(sum, 0);
  EXPECT_LT(difference / sum, 2e-4);
  EXPECT_LT(pixel_xyz(a, 31, 31)[1], pixel_xyz(a, 16, 16)[1]);  // both materials are in view
}

TEST(Estimators, InstancedEllipsoidsKeepTheFurnace) {
  SceneDesc scene = empty_scene();
  scene.materials = {lambert("white", 1)};
  scene.groups = {{"ball", {sphere({0, 0, 0}, 1, "white")}}};
  scene.shapes = {moved({.where = "", .kind = InstanceDesc{"ball"}}, scaling({1, Float(-0.3), 2}))};
  scene.camera.fov_deg = 10;
  scene.lights = {sky(1)};
  scene.integrator.max_depth = 1;  // a self-shadow would show
  const Estimate y = estimate_y(render_scene(scene, 1024).image);
  EXPECT_NEAR(y.mean, 1, kSigmas * y.standard_error);
}

}  // namespace
}  // namespace spectrace::test
