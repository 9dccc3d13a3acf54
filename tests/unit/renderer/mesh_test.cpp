// SPDX-License-Identifier: Apache-2.0
#include "renderer/mesh.h"

#include <gtest/gtest.h>

#include <fstream>
#include <limits>

#include "core/base/error.h"
#include "renderer/obj_file.h"

namespace spectrace {
namespace {

constexpr Float kNan = std::numeric_limits<Float>::quiet_NaN();

TriangleMesh good_triangle() {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  return mesh;
}

TEST(Mesh, TrianglesThatCannotBeHitAreCountedAndDropped) {
  TriangleMesh mesh = good_triangle();
  mesh.positions.insert(mesh.positions.end(), {{kNan, 0, 0}, {Float(2e18), 0, 0}, {2, 0, 0}});
  mesh.triangles = {{0, 1, 2}, {0, 1, 3}, {0, 2, 4}, {0, 1, 5}, {0, 0, 1}, {2, 0, 1}, {0, 2, 1}};
  MeshReport report;
  const TriangleMesh placed = place_mesh(mesh, {}, report);
  EXPECT_EQ(placed.triangles.size(), 1U);
  EXPECT_EQ(report.non_finite, 1U);
  EXPECT_EQ(report.too_large, 1U);
  EXPECT_EQ(report.zero_area, 2U);
  EXPECT_EQ(report.duplicate, 2U);
  EXPECT_EQ(report.text(7),
            "6 of 7 triangles skipped (1 not finite, 1 too large, 2 without area, 2 duplicate)");
  for (Vec3 p : placed.positions) EXPECT_TRUE(is_finite(p) && max_abs(p) <= kLargestCoordinate);
}

TEST(Mesh, TinyTrianglesHaveArea) {
  TriangleMesh mesh = good_triangle();
  for (Vec3& p : mesh.positions) p = p * Float(1e-25);
  MeshReport report;
  EXPECT_EQ(place_mesh(mesh, {}, report).triangles.size(), 1U);
}

TEST(Mesh, BadNormalsAreCountedAndReplaced) {
  TriangleMesh mesh = good_triangle();
  mesh.normals = {{0, 0, 0}, {kNan, 0, 1}, {0, 0, 2}};
  MeshReport report;
  const TriangleMesh placed = place_mesh(mesh, {}, report);
  EXPECT_EQ(report.bad_normals, 2U);
  EXPECT_EQ(report.text(1), "2 normals zero or not finite, replaced by the triangle's own");
  EXPECT_EQ(placed.normals[0], Vec3{});
  EXPECT_EQ(placed.normals[2], (Vec3{0, 0, 1}));
}

TEST(Mesh, ReflectionsKeepFrontsInFront) {
  Transform mirror;
  mirror.m[2][2] = -1;
  TriangleMesh mesh = good_triangle();
  mesh.normals = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
  for (Vec3& p : mesh.positions) p.z = 1;  // a front that faces away from the origin
  MeshReport report;
  const TriangleMesh placed = place_mesh(mesh, mirror, report);
  const auto [a, b, c] = placed.triangles[0];
  const Vec3 normal =
      cross(placed.positions[b] - placed.positions[a], placed.positions[c] - placed.positions[a]);
  EXPECT_EQ(placed.positions[a].z, -1);
  EXPECT_LT(normal.z, 0);
  EXPECT_EQ(placed.normals[0], (Vec3{0, 0, -1}));
}

std::filesystem::path write(const char* name, const char* text) {
  const auto file = std::filesystem::path(testing::TempDir()) / name;
  std::ofstream(file) << text;
  return file;
}

TEST(Mesh, ObjFacesBecomeTrianglesWithTheirNormalsAndCoordinates) {
  const auto file = write("quad.obj",
                          "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\n"
                          "f 1/1/1 2/2/1 3/3/1 4/4/1\n");
  const TriangleMesh mesh = read_obj(file);
  EXPECT_EQ(mesh.triangles.size(), 2U);
  EXPECT_EQ(mesh.positions.size(), 4U);
  EXPECT_EQ(mesh.normals.size(), 4U);
  ASSERT_EQ(mesh.uvs.size(), 4U);
  for (int i = 0; i < 4; ++i) {  // in this file texture coordinates equal positions
    EXPECT_EQ(mesh.uvs[i].x, mesh.positions[i].x);
    EXPECT_EQ(mesh.uvs[i].y, mesh.positions[i].y);
  }
}

TEST(Mesh, BadObjFilesAreInputErrors) {
  EXPECT_THROW((void)read_obj("/nowhere/x.obj"), InputError);
  EXPECT_THROW((void)read_obj(write("range.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 9\n")), InputError);
  EXPECT_THROW((void)read_obj(write("zero.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 0 1 2\n")), InputError);
}

}  // namespace
}  // namespace spectrace
