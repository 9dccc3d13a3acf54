// SPDX-License-Identifier: Apache-2.0
#include "renderer/provenance.h"
#include "renderer/scene.h"

#include <gtest/gtest.h>

#include <limits>

#include "core/base/error.h"
#include "renderer/render.h"
#include "tests/support/render_scenes.h"

namespace spectrace::test {
namespace {

class Notes final : public Progress {
 public:
  void update(std::string_view, double, double) override {}
  void note(std::string_view text) override { notes.emplace_back(text); }
  std::vector<std::string> notes;
};

std::string problem_of(const SceneDesc& scene) {
  SilentProgress progress;
  try {
    (void)build_scene(scene, progress);
  } catch (const InputError& e) {
    return e.diagnostics().front().text();
  }
  return "";
}

TEST(BuildScene, NamesTheJsonPlaceOfWhatIsWrong) {
  SceneDesc scene = empty_scene();
  scene.materials = {lambert("grey", Float(0.5))};
  scene.shapes = {sphere({0, 0, 0}, 1, "gray")};
  scene.shapes[0].where = "12:5: /shapes/0";
  EXPECT_EQ(problem_of(scene), "test.json:12:5: /shapes/0: no material is named \"gray\"");
  scene.shapes[0].material = "grey";
  scene.shapes[0].to_world = scaling({1, 2, 1});
  EXPECT_NE(problem_of(scene).find("scaled alike"), std::string::npos);
  scene.shapes[0] = {.where = "3:1: /shapes/0", .kind = InstanceDesc{"nothing"}};
  EXPECT_EQ(problem_of(scene), "test.json:3:1: /shapes/0: no group is named \"nothing\"");
  scene.groups = {{"nothing", {}}};
  scene.shapes[0].to_world = scaling({1, 0, 1});
  EXPECT_NE(problem_of(scene).find("invertible"), std::string::npos);
  scene = empty_scene();
  scene.lights = {sky(1), sky(1)};
  EXPECT_EQ(problem_of(scene), "test.json:/lights/1: a scene has at most one environment");
  scene = empty_scene();
  scene.camera.up = {0, 1, 0};
  EXPECT_NE(problem_of(scene).find("/camera/up"), std::string::npos);
  scene = empty_scene();
  scene.materials = {lambert("grey", Float(0.5))};
  scene.shapes = {{.where = "7:7",
                   .kind = MeshDesc{.positions = {{0, 0, 0}}, .triangles = {{0, 0, 1}}},
                   .material = "grey"}};
  EXPECT_EQ(problem_of(scene), "test.json:7:7: a triangle names vertex 1 of 1");
}

TEST(BuildScene, WhatCannotBeHitIsNotedAndLeftOut) {
  SceneDesc scene = empty_scene();
  scene.materials = {lambert("grey", Float(0.5))};
  MeshDesc mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {std::numeric_limits<Float>::quiet_NaN(), 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  scene.shapes = {emitting({.where = "/shapes/0", .kind = mesh, .material = "grey"}, 1),
                  emitting(quad({0, 0, 0}, {1, 0, 0}, {2, 0, 0}, "grey"), 1),
                  emitting(sphere({0, 0, 0}, 0, "grey"), 1),
                  {.where = "/shapes/3", .kind = MeshDesc{}, .material = "grey"}};
  scene.groups = {{"hollow", {sphere({0, 0, 0}, 0, "grey")}}};
  scene.shapes.push_back({.where = "/shapes/4", .kind = InstanceDesc{"hollow"}});
  Notes notes;
  const Scene built = build_scene(scene, notes);
  EXPECT_TRUE(built.geometry.shapes.empty());
  EXPECT_TRUE(built.geometry.instances.empty());
  EXPECT_EQ(built.lights.area_count(), 0U);
  ASSERT_EQ(notes.notes.size(), 7U);
  EXPECT_EQ(notes.notes[1], "mesh /shapes/0: 1 of 1 triangles skipped (1 not finite)");
  // And what is left renders.
  EXPECT_EQ(render(built, {.spp = 1}, notes).report.invalid_samples, 0U);
}

TEST(BuildScene, AnEmissionOfZeroIsNoLight) {
  SceneDesc scene = empty_scene();
  scene.materials = {lambert("grey", Float(0.5))};
  scene.shapes = {emitting(sphere({0, 0, 0}, 1, "grey"), 0)};
  SilentProgress progress;
  EXPECT_EQ(build_scene(scene, progress).lights.area_count(), 0U);
}

TEST(Provenance, SaysWhatWentIn) {
  SceneDesc desc = empty_scene();
  desc.sha256 = "abc";
  desc.range = {400, 700};
  SilentProgress progress;
  const Scene scene = build_scene(desc, progress);
  const RenderOptions options{.spp = 3, .seed = 18446744073709551615U, .threads = 1};
  const Metadata metadata = provenance(scene, options, render(scene, options, progress).report);
  EXPECT_EQ(std::get<std::string>(metadata.at("spectrace:sceneSha256")), "abc");
  EXPECT_EQ(std::get<std::string>(metadata.at("spectrace:seed")), "18446744073709551615");
  EXPECT_EQ(std::get<std::int64_t>(metadata.at("spectrace:spp")), 3);
  EXPECT_EQ(std::get<std::string>(metadata.at("spectrace:sampleRange")), "0:3");
  EXPECT_EQ(std::get<double>(metadata.at("spectrace:lambdaMinNm")), 400);
  EXPECT_EQ(std::get<std::string>(metadata.at("spectrace:kernel")), "box");
  for (const char* key :
       {"spectrace:version", "spectrace:commit", "spectrace:materialSha256s", "spectrace:seconds",
        "spectrace:threads", "spectrace:isa", "spectrace:effectsUsed", "spectrace:effectsSkipped",
        "spectrace:invalidSamples", "spectrace:units", "spectrace:extrapolatedShare"}) {
    EXPECT_TRUE(metadata.contains(key)) << key;
  }
}

}  // namespace
}  // namespace spectrace::test
