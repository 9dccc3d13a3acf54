// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/spectra/color.h"
#include "renderer/scene_desc.h"

namespace spectrace {
namespace {

const std::filesystem::path kScenes = std::filesystem::path(SPECTRACE_SOURCE_DIR) / "scenes";

/// A scene with one camera, one material "clay" and what `rest` adds.
std::string scene_with(const std::string& rest) {
  return R"({"camera": {"origin": [0, -5, 2], "target": [0, 0, 1], "up": [0, 0, 1]},
"materials": [{"name": "clay", "type": "lambert", "reflectance": 0.5}])" +
         (rest.empty() ? "" : ",\n" + rest) + "}";
}

SceneDesc parse(const std::string& text) { return parse_scene(text, kScenes / "test.json"); }

/// "line:column: /pointer: problem" of every diagnostic.
std::vector<std::string> problems(const std::string& text) {
  std::vector<std::string> all;
  try {
    parse(text);
  } catch (const InputError& e) {
    for (const Diagnostic& d : e.diagnostics()) {
      EXPECT_EQ(d.file, (kScenes / "test.json").string());
      all.push_back(d.where + ": " + d.problem);
    }
  }
  return all;
}

void expect_problem(const std::string& rest, const std::string& expected) {
  const std::vector<std::string> found = problems(scene_with(rest));
  ASSERT_EQ(found.size(), 1U) << rest << (found.empty() ? "" : "\n" + found[0] + "\n" + found.back());
  EXPECT_NE(found[0].find(expected), std::string::npos)
      << "expected: " << expected << "\nfound: " << found[0];
}

Transform transform_of(const std::string& json) {
  return parse(scene_with(R"("shapes": [{"type": "sphere", "material": "clay", "transform": )" + json + "}]"))
      .shapes.at(0)
      .to_world;
}

// 1e-6: rotations by whole degrees of vectors of length 10 or less, in single precision.
void expect_near(Vec3 a, Vec3 b) { EXPECT_LE(length(a - b), 1e-6 * 10) << a.x << ' ' << a.y << ' ' << a.z; }

TEST(SceneParser, FillsInTheDefaults) {
  const SceneDesc scene = parse(R"({"camera": {"origin": [0, 0, 5], "target": [0, 0, 0]}})");
  EXPECT_EQ(scene.range, (WavelengthRange{360, 830}));
  EXPECT_TRUE(scene.visible_sampling);
  EXPECT_EQ(scene.film.width, 512);
  EXPECT_EQ(scene.film.height, 512);
  EXPECT_EQ(scene.spp, 64);
  EXPECT_EQ(scene.seed, 0U);
  EXPECT_EQ(scene.sampler, SamplerKind::kOwenSobol);
  EXPECT_EQ(scene.integrator.max_depth, 8);
  EXPECT_EQ(scene.integrator.roulette_depth, 4);
  EXPECT_TRUE(scene.integrator.next_event);
  EXPECT_EQ(scene.camera.fov_deg, Float(45));
  EXPECT_TRUE(scene.shapes.empty() && scene.lights.empty() && scene.materials.empty() &&
              scene.groups.empty());
}

TEST(SceneParser, ReadsEverySection) {
  const SceneDesc scene = parse(scene_with(R"(
"$schema": "scene.schema.json",  // a comment
"spectrum": {"range_nm": [360, 1000], "sampling": "uniform"},
"film": {"width": 64, "height": 48}, "sampler": {"spp": 7, "seed": 9007199254740993, "type": "independent"},
"integrator": {"max_depth": 3, "roulette_depth": 2, "next_event": false},
"groups": [{"name": "pair", "shapes": [{"type": "sphere", "material": "clay", "radius": 2}]}],
"shapes": [{"type": "instance", "group": "pair", "transform": {"translate": [1, 2, 3]}},
           {"type": "quad", "material": "clay", "corner": [0, 0, 4], "edge_u": [1, 0, 0], "edge_v": [0, 1, 0],
            "emission": 3},
           {"type": "mesh", "material": "clay", "file": "meshes/torus.obj", "smooth_normals": false}],
"lights": [{"type": "point", "position": [1, 1, 1], "intensity": 2},
           {"type": "directional", "direction": [0, 0, -2], "irradiance": 1},
           {"type": "environment", "radiance": 0.5, "scale": 2}])"));
  EXPECT_EQ(scene.range, (WavelengthRange{360, 1000}));
  EXPECT_FALSE(scene.visible_sampling);
  EXPECT_EQ(scene.sampler, SamplerKind::kIndependent);
  EXPECT_EQ(scene.seed, 9007199254740993U);  // more digits than a double has
  EXPECT_FALSE(scene.integrator.next_event);
  ASSERT_EQ(scene.shapes.size(), 3U);
  EXPECT_EQ(std::get<InstanceDesc>(scene.shapes[0].kind).group, "pair");
  EXPECT_EQ(scene.shapes[0].to_world.point({}), (Vec3{1, 2, 3}));
  ASSERT_TRUE(scene.shapes[1].emission.has_value());
  EXPECT_EQ(scene.shapes[1].emission->at(550), Float(3));
  EXPECT_FALSE(scene.shapes[2].emission.has_value());
  EXPECT_EQ(std::get<MeshDesc>(scene.shapes[2].kind).file, kScenes / "meshes/torus.obj");
  EXPECT_FALSE(std::get<MeshDesc>(scene.shapes[2].kind).smooth_normals);
  EXPECT_NE(scene.shapes[2].where.find("/shapes/2"), std::string::npos);
  ASSERT_EQ(scene.lights.size(), 3U);
  EXPECT_EQ(std::get<DirectionalLightDesc>(scene.lights[1]).direction, (Vec3{0, 0, -1}));
  EXPECT_EQ(std::get<EnvironmentDesc>(scene.lights[2]).scale, Float(2));
}

TEST(SceneParser, ReadsEveryCamera) {
  const auto camera = [](const std::string& rest) {
    return parse(R"({"camera": {"origin": [0, 0, 5], "target": [0, 0, 0])" + rest + "}}").camera;
  };
  EXPECT_EQ(camera("").projection, Projection::kPerspective);
  EXPECT_EQ(camera("").lens_radius, Float(0));
  const CameraDesc lens = camera(R"(, "type": "thin_lens", "lens_radius": 0.25, "focus_distance": 3)");
  EXPECT_EQ(lens.projection, Projection::kPerspective);
  EXPECT_EQ(lens.lens_radius, Float(0.25));
  EXPECT_EQ(lens.focus_distance, Float(3));
  const CameraDesc parallel = camera(R"(, "type": "orthographic", "view_size": 7)");
  EXPECT_EQ(parallel.projection, Projection::kOrthographic);
  EXPECT_EQ(parallel.view_size, Float(7));
}

TEST(SceneParser, ACropWindowLiesWithinTheImage) {
  const FilmDesc film =
      parse(scene_with(R"("film": {"width": 64, "height": 48, "crop": [3, 5, 61, 7]})")).film;
  ASSERT_TRUE(film.crop.has_value());
  EXPECT_EQ(film.window().x, 3);
  EXPECT_EQ(film.window().y, 5);
  EXPECT_EQ(film.window().width, 61);
  EXPECT_EQ(film.window().height, 7);
  expect_problem(R"("film": {"width": 64, "height": 48, "crop": [3, 5, 62, 7]})", "/film/crop/2");
  expect_problem(R"("film": {"width": 64, "height": 48, "crop": [64, 5, 1, 7]})", "/film/crop/0");
  expect_problem(R"("film": {"width": 64, "height": 48, "crop": [0, 0, 8]})",
                 "expected [x, y, width, height]");
}

TEST(SceneParser, HashesTheText) {
  // The SHA-256 of a file is what sha256sum prints; FIPS 180-4 vectors are tested with the function.
  const std::string text = scene_with("");
  EXPECT_EQ(parse(text).sha256, sha256_hex(std::as_bytes(std::span(text))));
  EXPECT_NE(parse(text).sha256, parse(text + "\n").sha256);
}

TEST(SceneParser, AppliesTheFirstTransformFirst) {
  const Transform t = transform_of(
      R"([{"scale": 2}, {"translate": [1, 0, 0]}, {"rotate": {"axis": [0, 0, 3], "angle_deg": 90}}])");
  expect_near(t.point({1, 0, 0}), {0, 3, 0});
  const Transform u = transform_of(
      R"([{"rotate": {"axis": [0, 0, 1], "angle_deg": 90}}, {"translate": [1, 0, 0]}, {"scale": [2, 3, 4]}])");
  expect_near(u.point({1, 0, 0}), {2, 3, 0});
}

TEST(SceneParser, RotatesCounterClockwiseSeenAgainstTheAxis) {
  expect_near(transform_of(R"({"rotate": {"axis": [1, 0, 0], "angle_deg": 90}})").point({0, 1, 0}),
              {0, 0, 1});
  expect_near(transform_of(R"({"rotate": {"axis": [0, 1, 0], "angle_deg": 90}})").point({0, 0, 1}),
              {1, 0, 0});
  expect_near(transform_of(R"({"rotate": {"axis": [1, 1, 1], "angle_deg": 120}})").point({1, 2, 3}),
              {3, 1, 2});
  expect_near(transform_of(R"({"rotate": {"axis": [0, 0, 1], "angle_deg": 3.6e9}})").point({1, 0, 0}),
              {1, 0, 0});
}

TEST(SceneParser, ReadsMatricesByRows) {
  const Transform t = transform_of(R"({"matrix": [0, 2, 0, 1,  3, 0, 0, 2,  0, 0, 4, 3]})");
  expect_near(t.point({1, 1, 1}), {3, 5, 7});
}

TEST(SceneParser, RefusesTransformsThatCannotBeInverted) {
  for (const char* bad :
       {R"({"scale": 0})", R"({"scale": [1, 0, 1]})", R"({"scale": [1e-30, 1e-30, 1e-46]})",
        R"({"matrix": [1, 2, 3, 0,  2, 4, 6, 0,  0, 0, 1, 0]})", R"([{"scale": 1e30}, {"scale": 1e30}])"}) {
    expect_problem(
        std::string(R"("shapes": [{"type": "sphere", "material": "clay", "transform": )") + bad + "}]",
        "/shapes/0/transform: expected a transform that can be inverted");
  }
  // Small, large and mirrored are no faults.
  expect_near(transform_of(R"({"scale": [-1e-4, 1e-4, 1e-4]})").point({1e4, 0, 0}), {-1, 0, 0});
  expect_near(transform_of(R"({"scale": 1e6})").point({1e-6F, 0, 0}), {1, 0, 0});
}

TEST(SceneParser, NamesTheNearestOfWhatAReferenceCouldMean) {
  expect_problem(R"("shapes": [{"type": "sphere", "material": "caly"}])",
                 R"(/shapes/0/material: there is no material "caly"; did you mean "clay"?)");
  expect_problem(
      R"("groups": [{"name": "forest", "shapes": []}], "shapes": [{"type": "instance", "group": "forst"}])",
      R"(/shapes/0/group: there is no group "forst"; did you mean "forest"?)");
  expect_problem(R"("shapes": [{"type": "sphere", "material": "clay", "raduis": 2}])",
                 R"(/shapes/0/raduis: unknown key "raduis"; did you mean "radius"?)");
  expect_problem(R"("shape": [])", R"(/shape: unknown key "shape"; did you mean "shapes"?)");
}

TEST(SceneParser, NamesFilesThatAreNotThere) {
  expect_problem(R"("shapes": [{"type": "mesh", "material": "clay", "file": "meshes/tours.obj"}])",
                 "/shapes/0/file: there is no file \"" + (kScenes / "meshes/tours.obj").string() + "\"");
  expect_problem(R"("lights": [{"type": "environment", "file": "sky.hdr"}])",
                 "/lights/0/file: there is no file");
  expect_problem(R"("shapes": [{"type": "mesh", "material": "clay", "file": "meshes"}])",
                 "is a folder, not a file");
  EXPECT_EQ(problems(R"({"camera": {"origin": [0, 0, 1], "target": [0, 0, 0]},
                         "materials": [{"name": "m", "type": "measured", "file": "none.bsdf"}]})"),
            std::vector<std::string>{"2:82: /materials/0/file: there is no file \"" +
                                     (kScenes / "none.bsdf").string() + "\""});
}

TEST(SceneParser, RefusesShapesThatAreNone) {
  expect_problem(
      R"("shapes": [{"type": "quad", "material": "clay", "corner": [0, 0, 0], "edge_u": [0, 0, 0], "edge_v": [0, 1, 0]}])",
      "/shapes/0/edge_u: expected a vector that is not zero");
  expect_problem(
      R"("shapes": [{"type": "quad", "material": "clay", "corner": [0, 0, 0], "edge_u": [1, 2, 3], "edge_v": [-2, -4, -6]}])",
      "/shapes/0/edge_v: is parallel to edge_u");
  expect_problem(R"("shapes": [{"type": "disk", "material": "clay", "normal": [0, 0, 0]}])",
                 "/shapes/0/normal: expected a vector that is not zero");
  expect_problem(R"("shapes": [{"type": "disk", "material": "clay", "radius": -1}])",
                 "/shapes/0/radius: expected a number > 0, ");
  expect_problem(R"("shapes": [{"type": "sphere", "material": "clay", "radius": 0}])",
                 "/shapes/0/radius: expected a number > 0, ");
  expect_problem(R"("shapes": [{"type": "sphere", "material": "clay", "radius": 1e300}])",
                 "/shapes/0/radius: expected a number > 0, ");
  expect_problem(
      R"("shapes": [{"type": "mesh", "material": "clay", "positions": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "triangles": [[0, 1, 3]]}])",
      "/shapes/0/triangles/0/2: expected an integer in [0, 2], got 3");
  expect_problem(
      R"("shapes": [{"type": "mesh", "material": "clay", "positions": [[0, 0, 0]], "triangles": [[0, 0]]}])",
      "/shapes/0/triangles/0: expected three indices");
  const auto mesh = [](const std::string& rest) {
    return R"("shapes": [{"type": "mesh", "file": "meshes/torus.obj", )" + rest + "}]";
  };
  expect_problem(mesh(R"("materials": {"gold": "caly"})"),
                 "/shapes/0/materials/gold: there is no material \"caly\"; did you mean \"clay\"?");
  expect_problem(mesh(R"("materials": {}, "emission": 2)"), "/shapes/0/emission: \"materials\" leaves it");
  expect_problem(mesh(R"("smooth_normals": true)"), "/shapes/0: missing required key \"material\"");
  EXPECT_TRUE(problems(scene_with(mesh(R"("materials": {}, "material": "clay")"))).empty());
  expect_problem(R"("shapes": [{"type": "mesh", "material": "clay"}])", "/shapes/0: a mesh needs a \"file\"");
  expect_problem(
      R"("shapes": [{"type": "instance", "group": "g", "material": "clay"}], "groups": [{"name": "g", "shapes": []}])",
      "/shapes/0/material: unknown key");
}

TEST(SceneParser, GroupsHoldNoInstancesAndNoLight) {
  expect_problem(
      R"("groups": [{"name": "g", "shapes": [{"type": "instance", "group": "g"}]}])",
      R"(/groups/0/shapes/0/type: expected one of "sphere", "quad", "disk", "mesh", got "instance")");
  expect_problem(
      R"("groups": [{"name": "g", "shapes": [{"type": "sphere", "material": "clay", "emission": 1}]}])",
      "/groups/0/shapes/0/emission: shapes inside groups cannot emit");
  expect_problem(R"("groups": [{"name": "g", "shapes": []}, {"name": "g", "shapes": []}])",
                 "/groups/1/name: \"g\" is the name of an earlier one");
}

TEST(SceneParser, RefusesCamerasThatCannotLook) {
  const auto camera = [](const std::string& json) { return problems(R"({"camera": )" + json + "}"); };
  EXPECT_EQ(camera(R"({"origin": [1, 2, 3], "target": [1, 2, 3]})"),
            std::vector<std::string>{
                "1:44: /camera/target: is the same point as the origin: the camera has nowhere to look"});
  EXPECT_EQ(
      camera(R"({"origin": [0, 0, 0], "target": [0, 5, 0]})"),
      std::vector<std::string>{R"(1:12: /camera: "up" is parallel to the direction from origin to target)"});
  EXPECT_EQ(camera(R"({"origin": [0, 0, 0], "target": [0, 0, 5], "up": [0, 0, -1]})"),
            std::vector<std::string>{
                R"(1:61: /camera/up: "up" is parallel to the direction from origin to target)"});
  for (const char* fov : {"0", "180", "-1", "1e300"}) {
    const auto found =
        camera(R"({"origin": [0, 0, 0], "target": [0, 0, 5], "fov_deg": )" + std::string(fov) + "}");
    ASSERT_EQ(found.size(), 1U) << fov;
    EXPECT_NE(found[0].find("/camera/fov_deg: expected a number in (0, 180)"), std::string::npos) << found[0];
  }
  EXPECT_EQ(camera("3"), std::vector<std::string>{"1:12: /camera: expected an object, got 3"});
}

TEST(SceneParser, KeepsSizesAndCountsInRange) {
  expect_problem(R"("film": {"width": 0})", "/film/width: expected an integer in [1, 65536], got 0");
  expect_problem(R"("film": {"height": 65537})",
                 "/film/height: expected an integer in [1, 65536], got 65537");
  expect_problem(R"("film": {"width": 65536, "height": 65536})", "/film: 65536 x 65536 pixels");
  expect_problem(R"("sampler": {"spp": 0})", "/sampler/spp: expected an integer in [1, 2147483647], got 0");
  expect_problem(R"("sampler": {"spp": 2147483648})", "/sampler/spp");
  expect_problem(R"("sampler": {"seed": -1})", "/sampler/seed");
  expect_problem(R"("sampler": {"type": "independant"})", "/sampler/type");
  expect_problem(R"("integrator": {"max_depth": 1.5})",
                 "/integrator/max_depth: expected an integer in [0, 65536], got 1.5");
  expect_problem(R"("spectrum": {"range_nm": [700, 400]})", "/spectrum/range_nm: expected [min, max]");
  expect_problem(R"("spectrum": {"range_nm": [900, 1000]})",
                 "/spectrum/range_nm: nothing of [900, 1000] nm is visible");
  expect_problem(R"("spectrum": {"range_nm": [50, 700]})",
                 "/spectrum/range_nm/0: expected a number in [100, 10000]");
}

TEST(SceneParser, LightsAreWhole) {
  expect_problem(R"("lights": [{"type": "environment"}])", "/lights/0: an environment needs");
  expect_problem(
      R"("lights": [{"type": "environment", "radiance": 1}, {"type": "environment", "radiance": 1}])",
      "/lights/1: a second environment");
  for (const char* bad : {R"({"scale": 2})", R"({"translate": [1, 0, 0]})", R"({"scale": [1, 1, -1]})"}) {
    expect_problem(
        std::string(R"("lights": [{"type": "environment", "radiance": 1, "transform": )") + bad + "}]",
        "/lights/0/transform: an environment can only be rotated");
  }
  expect_problem(R"("lights": [{"type": "directional", "direction": [0, 0, 0], "irradiance": 1}])",
                 "/lights/0/direction: expected a vector that is not zero");
  expect_problem(R"("lights": [{"type": "spot", "position": [0, 0, 0], "intensity": 1, "cone_deg": 20}])",
                 "/lights/0: a spot light needs a \"direction\" or a \"target\"");
  const auto spot = [](const std::string& rest) {
    return R"("lights": [{"type": "spot", "position": [0, 0, 1], "intensity": 1, )" + rest + "}]";
  };
  expect_problem(spot(R"("cone_deg": 20, "direction": [0, 0, 1], "target": [0, 0, 0])"), "and not both");
  expect_problem(spot(R"("cone_deg": 20, "target": [0, 0, 1])"),
                 "/lights/0/target: is the same point as the position");
  expect_problem(spot(R"("cone_deg": 0, "target": [0, 0, 0])"),
                 "/lights/0/cone_deg: expected a number in (0, 180], got 0");
  expect_problem(spot(R"("cone_deg": 20, "falloff_deg": 21, "target": [0, 0, 0])"),
                 "/lights/0/falloff_deg: must not exceed cone_deg");
  const auto lamp = std::get<SpotLightDesc>(
      parse(scene_with(spot(R"("cone_deg": 20, "target": [0, 0, -4])"))).lights.at(0));
  EXPECT_EQ(lamp.direction, (Vec3{0, 0, -1}));
  EXPECT_EQ(lamp.falloff_deg, Float(15));
  const SceneDesc scene = parse(scene_with(R"("lights": [{"type": "environment", "radiance": 1, "transform":
      [{"rotate": {"axis": [1, 0, 0], "angle_deg": 90}}, {"rotate": {"axis": [1, 2, 3], "angle_deg": 77}}]}])"));
  EXPECT_EQ(scene.lights.size(), 1U);
}

TEST(SceneParser, ReportsAllMistakesOfAFileInTheirOrder) {
  const std::vector<std::string> found = problems(R"({
  "camera": {"origin": [0, 0, 1], "target": [0, 0]},
  "film": {"width": "wide"},
  "shapes": [{"type": "sphere", "material": "none"}, {"type": "spere", "material": "none"}],
  "lihgts": []})");
  const std::vector<std::string> starts{
      "2:45: /camera/target: ", "3:21: /film/width: ", "4:45: /shapes/0/material: ", "4:63: /shapes/1/type: ",
      "5:3: /lihgts: "};
  ASSERT_EQ(found.size(), starts.size());
  for (std::size_t i = 0; i < starts.size(); ++i) {
    EXPECT_TRUE(found[i].starts_with(starts[i])) << found[i];
  }
}

TEST(SceneParser, RefusesWhatIsNoScene) {
  EXPECT_EQ(problems("[]").size(), 1U);
  EXPECT_EQ(problems("{}"), std::vector<std::string>{"1:1: missing required key \"camera\""});
  EXPECT_EQ(problems("").size(), 1U);
  EXPECT_EQ(problems(R"({"camera": )").size(), 1U);
  EXPECT_THROW(load_scene(kScenes / "none.json"), InputError);
  EXPECT_THROW(load_scene(kScenes), InputError);
}

TEST(Scenes, CornellLampHasTheLuminanceOfItsPeers) {
  const SceneDesc scene = load_scene(kScenes / "cornell_box.json");
  const auto lamp =
      std::find_if(scene.shapes.begin(), scene.shapes.end(), [](const auto& s) { return s.emission; });
  ASSERT_NE(lamp, scene.shapes.end());
  // 12.36855: luminance of the lamp in pbrt-v4's version of the box, computed there from the same four
  // figures. Both integrate by steps of 1 nm; 1e-3 is 10 x the difference observed.
  EXPECT_NEAR(spectrum_to_xyz(*lamp->emission)[1], 12.36855, 12.36855 * 1e-3);
}

}  // namespace
}  // namespace spectrace
