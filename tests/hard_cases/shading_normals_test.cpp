// SPDX-License-Identifier: Apache-2.0
// H17: normals that are bent away from the surface's own, and backs of surfaces.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "tests/support/render_scenes.h"
#include "tests/support/temporary_folder.h"

namespace spectrace::test {
namespace {

/// An octahedron-like ball of few triangles with smooth normals, as an OBJ.
std::filesystem::path write_smooth_ball(int rings, int segments) {
  const MeshDesc mesh = polyhedral_sphere(rings, segments);
  const auto file = std::filesystem::path(testing::TempDir()) / "smooth_ball.obj";
  std::ofstream out(file);
  for (Vec3 p : mesh.positions) out << "v " << p.x << ' ' << p.y << ' ' << p.z << '\n';
  for (Vec3 p : mesh.positions) out << "vn " << p.x << ' ' << p.y << ' ' << p.z << '\n';
  for (const auto& t : mesh.triangles) {
    out << 'f';
    for (auto i : t) out << ' ' << i + 1 << "//" << i + 1;
    out << '\n';
  }
  return file;
}

TEST(H17_ShadingNormals, MakeNoBlackRims) {
  // Eight segments turn the normals far off; at the rim they face away from the viewer.
  SceneDesc scene = empty_scene();
  scene.film = {48, 48};
  scene.materials = {lambert("white", 1)};
  scene.shapes = {{.where = "", .kind = MeshDesc{.file = write_smooth_ball(5, 8)}, .material = "white"}};
  scene.camera.fov_deg = 24;
  scene.lights = {sky(1)};
  const Image image = render_scene(scene, 256).image;
  double darkest = 1;
  for (int y = 0; y < 48; ++y) {
    for (int x = 0; x < 48; ++x) darkest = std::min(darkest, pixel_xyz(image, x, y)[1]);
  }
  // A normal turned by half a facet (22 degrees) cannot hide more than a third of the sky.
  EXPECT_GT(darkest, 0.6);
}

TEST(H17_ShadingNormals, LeakNoLight) {
  // A lone triangle whose normals lean over by 45 degrees, a lamp below its plane but above theirs.
  const auto file = std::filesystem::path(testing::TempDir()) / "leaning_normals.obj";
  std::ofstream(file) << "v -1 -1 0\nv 1 -1 0\nv 0 1 0\nvn 1 0 1\nf 1//1 2//1 3//1\n";
  SceneDesc scene = empty_scene();
  scene.materials = {lambert("white", 1)};
  scene.shapes = {{.where = "", .kind = MeshDesc{.file = file}, .material = "white"}};
  look_at_point(scene, {0, 0, 5}, {0, Float(-0.2), 0});
  scene.camera.up = {0, 1, 0};
  const auto lit_from = [&](Vec3 to_light) {
    scene.lights = {DirectionalLightDesc{-normalize(to_light), Spectrum::constant(1)}};
    return estimate_y(render_scene(scene, 16).image).mean;
  };
  EXPECT_GT(lit_from({1, 0, Float(0.2)}), 0);
  EXPECT_EQ(lit_from({1, 0, Float(-0.2)}), 0);
}

TEST(H17_ShadingNormals, BothSidesOfAOneSidedMaterialShade) {
  SceneDesc scene = empty_scene();
  scene.materials = {lambert("grey", Float(0.5))};
  scene.shapes = {quad({-5, 0, -5}, {10, 0, 0}, {0, 0, 10}, "grey")};
  scene.lights = {sky(1)};
  for (Float y : {Float(-5), Float(5)}) {
    scene.camera.origin = {0, y, 0};
    const Estimate e = estimate_y(render_scene(scene, 256).image);
    EXPECT_NEAR(e.mean, 0.5, 4 * e.standard_error);
  }
}

}  // namespace
}  // namespace spectrace::test
