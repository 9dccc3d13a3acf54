// SPDX-License-Identifier: Apache-2.0
#include "tests/support/scene_zoo.h"

#include <cmath>
#include <filesystem>

#include "materials/measured_tables.h"
#include "tests/support/render_scenes.h"
#include "tests/support/synthetic_measured.h"
#include "tests/support/synthetic_separated.h"

namespace spectrace::test {

namespace {

const SellmeierSpectrum kBk7{.b = {Float(1.03961212), Float(0.231792344), Float(1.01046945)},
                             .c_um2 = {Float(0.00600069867), Float(0.0200179144), Float(103.560653)}};

SpecularFresnel grey_metal() {
  return ConductorFresnel{.eta = Spectrum::constant(Float(0.2)), .k = Spectrum::constant(3)};
}

MaterialDesc glossy(const std::string& name, Texture reflectance) {
  return {
      .name = name,
      .where = "",
      .kind = Glossy{
          .reflectance = std::move(reflectance), .fresnel = grey_metal(), .ggx = {Float(0.2), Float(0.2)}}};
}
MaterialDesc mirror(const std::string& name) {
  return {.name = name,
          .where = "",
          .kind = SmoothConductor{{.eta = Spectrum::constant(Float(0.2)), .k = Spectrum::constant(3)}}};
}
MaterialDesc glass(const std::string& name, Spectrum eta) {
  return {.name = name, .where = "", .kind = Dielectric{std::move(eta)}};
}

/// Lamps of every kind and both ways up around a ball, of glass at that: more than a node of the light tree
/// has.
void add_many_lights(SceneDesc& scene) {
  for (int i = 0; i < 24; ++i) {
    const Float phi = Float(i), r = 2 + Float(i % 5), z = Float(0.3) + Float(i % 7) / 2;
    const Vec3 at{r * std::cos(phi), r * std::sin(phi), z};
    if (i % 3 == 0) {
      scene.shapes.push_back(emitting(sphere(at, Float(0.15), "black"), 20));
    } else if (i % 3 == 1) {
      const Vec3 down{0, Float(0.3), 0}, across{Float(0.3), 0, 0};
      scene.shapes.push_back(
          emitting(i % 2 == 0 ? quad(at, down, across, "black") : quad(at, across, down, "black"), 20));
    } else {
      scene.lights.emplace_back(PointLightDesc{at, Spectrum::constant(Float(0.3))});
    }
  }
}

/// A ball on a floor, seen from the side.
SceneDesc ball_scene(MaterialDesc ball, MaterialDesc floor) {
  SceneDesc scene = empty_scene();
  scene.film = {24, 20};
  scene.camera = {
      .origin = {0, -6, Float(2.2)}, .target = {0, 0, Float(0.9)}, .up = {0, 0, 1}, .fov_deg = 38};
  scene.shapes = {quad({-8, -8, 0}, {16, 0, 0}, {0, 16, 0}, floor.name), sphere({0, 0, 1}, 1, ball.name)};
  scene.materials = {std::move(ball), std::move(floor), lambert("black", 0)};
  return scene;
}

ShapeDesc lamp() { return emitting(sphere({-2, -2, Float(4.5)}, Float(0.5), "black"), 12); }

SceneDesc box_scene() {
  SceneDesc scene = empty_scene();
  scene.film = {20, 24};
  scene.camera = {.origin = {0, Float(-0.95), 0}, .target = {0, 1, 0}, .up = {0, 0, 1}, .fov_deg = 80};
  scene.materials = {lambert("white", Float(0.7)),
                     lambert("red", TabulatedSpectrum({360, 580, 640, 830},
                                                      {Float(0.05), Float(0.1), Float(0.7), Float(0.8)})),
                     glossy("glossy", Spectrum::constant(Float(0.4))), lambert("black", 0)};
  scene.shapes = inward_box("white");
  scene.shapes[0].material = "red";
  scene.shapes.push_back(sphere({Float(0.3), Float(0.4), Float(-0.6)}, Float(0.4), "glossy"));
  scene.shapes.push_back(emitting(
      quad({Float(-0.3), Float(-0.3), Float(0.99)}, {0, Float(0.6), 0}, {Float(0.6), 0, 0}, "black"), 15));
  return scene;
}

SceneDesc instance_scene() {
  SceneDesc scene = ball_scene(glossy("ball", Spectrum::constant(Float(0.5))), lambert("floor", Float(0.5)));
  scene.shapes.pop_back();
  scene.groups = {{"pair",
                   {sphere({0, 0, 1}, Float(0.5), "ball"),
                    disk({0, 0, Float(1.7)}, {0, -1, 1}, Float(0.3), "ball"),
                    {.where = "",
                     .kind = polyhedral_sphere(6, 9),
                     .material = "floor",
                     .to_world = scaling({Float(0.3), Float(0.3), Float(0.6)})}}}};
  for (int i = 0; i < 3; ++i) {
    const Transform turn =
        rotation_z(Float(40 * i)).compose(scaling({i == 1 ? Float(-1) : Float(1), 1, Float(0.7 + 0.3 * i)}));
    scene.shapes.push_back({.where = "",
                            .kind = InstanceDesc{"pair"},
                            .to_world = translation({Float(1.5 * (i - 1)), 0, Float(0.2)}).compose(turn)});
  }
  scene.shapes.push_back(lamp());
  scene.lights = {sky(Float(0.3))};
  return scene;
}

MaterialDesc made_of(const std::string& name, decltype(MaterialDesc::kind) kind) {
  return {.name = name, .where = "", .kind = std::move(kind)};
}

NormalTexture bumps() {
  Image image(2, 2, {"R", "G", "B"});
  image.data = {0.6F, 0.5F, 0.9F, 0.5F, 0.7F, 0.9F, 0.4F, 0.5F, 0.9F, 0.5F, 0.3F, 0.9F};
  return NormalTexture(CachedImage(image));
}

/// Finer than pixels see it, on all that can be hit.
Texture fine_image() {
  Image image(300, 200, {"R", "G", "B"});
  for (std::size_t i = 0; i < image.data.size(); ++i) image.data[i] = float(i * 7919 % 100) / 100;
  return BitmapTexture(image);
}

SceneDesc nested_scene() {
  const MaterialDesc bumpy = made_of(
      "", NormalMappedDesc{.parts = {glossy("", Spectrum::constant(Float(0.5)))}, .normals = bumps()});
  const ScalarCheckerboard board{.even = Float(0.2), .odd = 1, .repeat = {8, 8}};
  SceneDesc scene =
      ball_scene(made_of("ball", MixDesc{.parts = {bumpy, mirror("")}, .weight = board}),
                 made_of("floor", TwoSidedDesc{.parts = {lambert("", Float(0.5)), mirror("")}}));
  scene.materials.push_back(
      made_of("pane", MaskedDesc{.parts = {lambert("", Float(0.8))}, .opacity = board}));
  scene.shapes.push_back(quad({-2, -2, 0}, {4, 0, 0}, {0, 0, 3}, "pane"));
  scene.shapes.push_back(lamp());
  scene.lights = {sky(Float(0.3))};
  return scene;
}

/// A measured file of a formula, anisotropic, turned by the tangents it meets.
MaterialDesc measured(const std::string& name) {
  const auto file = std::filesystem::temp_directory_path() / "spectrace_scene_zoo.bsdf";
  measured_to_tensors(make_measured({.isotropic = false})).write(file);
  return {.name = name, .where = "", .kind = MeasuredDesc{file}};
}

MaterialDesc separated(const std::string& name) {
  const auto file = std::filesystem::temp_directory_path() / "spectrace_scene_zoo.sep";
  separated_to_tensors(*synthetic_separated({.grid = {.n_theta_h = 16, .n_theta_d = 16, .n_phi_d = 24}}))
      .write(file);
  return {.name = name, .where = "", .kind = SeparatedDesc{file, SeparationModel::kDiffraction}};
}

}  // namespace

std::vector<NamedScene> scene_zoo() {
  std::vector<NamedScene> zoo;
  zoo.push_back({"empty", empty_scene()});
  zoo.push_back({"empty under a sky", empty_scene()});
  zoo.back().scene.lights = {sky(2)};
  zoo.push_back({"box", box_scene()});
  zoo.push_back({"box, direct light only", box_scene()});
  zoo.back().scene.integrator = {.max_depth = 1, .roulette_depth = 0};
  zoo.push_back({"box, no light sampling", box_scene()});
  zoo.back().scene.integrator.next_event = false;
  zoo.push_back({"diffuse ball", ball_scene(lambert("ball", Float(0.6)), lambert("floor", Float(0.4)))});
  zoo.back().scene.shapes.push_back(lamp());
  zoo.back().scene.lights = {sky(Float(0.3))};
  zoo.push_back(
      {"glossy ball, checkered floor, delta lights",
       ball_scene(glossy("ball", Spectrum::constant(Float(0.5))),
                  {.name = "floor",
                   .where = "",
                   .kind = Lambert{Texture(Checkerboard{Spectrum::constant(Float(0.2)),
                                                        Spectrum::constant(Float(0.8)), 16, 16})}})});
  zoo.back().scene.lights = {
      PointLightDesc{{2, -2, 3}, Spectrum::constant(20)},
      SpotLightDesc{{-2, -3, 4}, normalize({2, 3, -3}), Spectrum::constant(30), 20, 10},
      DirectionalLightDesc{normalize({1, 1, -1}), Spectrum::constant(1)}};
  zoo.push_back({"mirror", ball_scene(mirror("ball"), glossy("floor", Spectrum::constant(Float(0.5))))});
  zoo.back().scene.shapes.push_back(lamp());
  zoo.back().scene.lights = {sky(Float(0.3))};
  zoo.push_back(
      {"glass", ball_scene(glass("ball", Spectrum::constant(Float(1.5))), lambert("floor", Float(0.5)))});
  zoo.back().scene.shapes.push_back(lamp());
  zoo.back().scene.lights = {sky(Float(0.3))};
  zoo.push_back(
      {"dispersing glass", ball_scene(glass("ball", kBk7), glossy("floor", Spectrum::constant(Float(0.5))))});
  zoo.back().scene.shapes.push_back(lamp());
  zoo.push_back(
      {"rough dispersing glass",
       ball_scene({.name = "ball", .where = "", .kind = RoughDielectric(kBk7, {Float(0.1), Float(0.3)})},
                  lambert("floor", Float(0.5)))});
  zoo.back().scene.shapes.push_back(lamp());
  zoo.back().scene.lights = {sky(Float(0.3))};
  zoo.push_back(
      {"plastic ball on a polished floor",
       ball_scene(
           {.name = "ball",
            .where = "",
            .kind = PlasticDesc{Spectrum::constant(Float(0.6)), Spectrum::constant(Float(1.5)), Float(0.1)}},
           {.name = "floor",
            .where = "",
            .kind = PlasticDesc{Spectrum::constant(Float(0.3)), Spectrum::constant(Float(1.5)), 0}})});
  zoo.back().scene.shapes.push_back(lamp());
  zoo.back().scene.lights = {sky(Float(0.3))};
  zoo.push_back({"checkered disk under a disk of light",
                 ball_scene(glossy("ball", Texture(Checkerboard{Spectrum::constant(Float(0.2)),
                                                                Spectrum::constant(Float(0.8)), 12, 6})),
                            lambert("floor", Float(0.5)))});
  zoo.back().scene.shapes[1] = moved(disk({0, 0, 0}, {0, -1, 1}, 1, "ball"),
                                     translation({0, 0, 1}).compose(scaling({Float(1.5), 1, 1})));
  zoo.back().scene.shapes.push_back(emitting(disk({-1, -1, 4}, {1, 1, -4}, 1, "black"), 6));
  zoo.push_back({"image on a glossy ball and its floor",
                 ball_scene(glossy("ball", fine_image()),
                            {.name = "floor", .where = "", .kind = Lambert{fine_image()}})});
  zoo.back().scene.shapes.push_back(lamp());
  zoo.back().scene.lights = {sky(Float(0.3))};
  zoo.push_back({"many lights", ball_scene(lambert("ball", Float(0.5)), lambert("floor", Float(0.5)))});
  add_many_lights(zoo.back().scene);
  zoo.push_back(
      {"many lights and sky around glass", ball_scene(glass("ball", kBk7), lambert("floor", Float(0.5)))});
  add_many_lights(zoo.back().scene);
  zoo.back().scene.lights.emplace_back(sky(Float(0.1)));
  zoo.push_back({"mixed and bumpy ball behind a masked pane", nested_scene()});
  zoo.push_back({"instances", instance_scene()});
  zoo.push_back({"measured ball", ball_scene(measured("ball"), lambert("floor", Float(0.4)))});
  zoo.back().scene.shapes.push_back(lamp());
  zoo.back().scene.lights = {sky(Float(0.3))};
  zoo.push_back({"separated ball", ball_scene(separated("ball"), lambert("floor", Float(0.4)))});
  zoo.back().scene.shapes.push_back(lamp());
  zoo.back().scene.lights = {sky(Float(0.3))};
  return zoo;
}

}  // namespace spectrace::test
