// SPDX-License-Identifier: Apache-2.0
// H15, H16: rays against the limits of single precision: scales, near misses, shared edges and vertices.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "renderer/surface.h"
#include "tests/support/render_scenes.h"

namespace spectrace::test {
namespace {

/// Does a ray that leaves a convex body (offset outwards) meet it again? Never, at any scale, distance,
/// angle.
std::size_t self_hits(const std::vector<ShapeDesc>& shapes, Float scale, Vec3 center, std::size_t rays) {
  SceneDesc desc = empty_scene();
  desc.materials = {lambert("grey", Float(0.5))};
  for (const ShapeDesc& shape : shapes) {
    desc.shapes.push_back(moved(shape, translation(center).compose(scaling({scale, scale, scale}))));
  }
  SilentProgress progress;
  const Scene scene = build_scene(desc, progress);
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  const auto direction = [&] {
    return normalize(Vec3{Float(normal(random)), Float(normal(random)), Float(normal(random))});
  };
  std::size_t hits = 0, found = 0;
  while (found < rays) {
    const Vec3 from = direction();
    const Ray ray{center + from * (3 * scale), -from + direction() * Float(0.1)};
    const auto hit = scene.accel.intersect(ray);
    if (!hit) continue;
    ++found;
    const SurfacePoint point = surface_point<SurfaceQuery{}>(scene.geometry, ray, *hit);
    Vec3 out = direction();
    if (dot(out, point.normal_g) < 0) out = -out;
    if (found % 2 == 0) {  // half of them grazing: within 1e-3 of the surface
      out = normalize(out - point.normal_g * (dot(out, point.normal_g) * Float(0.999)));
    }
    hits += scene.accel.occluded({ray_origin(point, out), out}) ? 1 : 0;
  }
  return hits;
}

TEST(H15_Scale, RaysLeaveConvexBodiesAtAnyScale) {
  const std::vector<ShapeDesc> ball{sphere({0, 0, 0}, 1, "grey")};
  const std::vector<ShapeDesc> polyhedron{
      {.where = "", .kind = polyhedral_sphere(20, 40), .material = "grey"}};
  for (Float scale : {Float(1e-4), Float(1), Float(1e6)}) {
    for (Float away : {Float(0), Float(100)}) {  // in units of the body
      const Vec3 center{away * scale, -away * scale * Float(0.7), away * scale * Float(0.3)};
      EXPECT_EQ(self_hits(ball, scale, center, 100000), 0U) << "ball, scale " << scale << ", away " << away;
      EXPECT_EQ(self_hits(outward_box("grey"), scale, center, 100000), 0U)
          << "box, scale " << scale << ", away " << away;
      // A polyhedron is convex to rounding only: neighbours of a facet may rise above it by that much.
      EXPECT_LE(self_hits(polyhedron, scale, center, 100000), 2U)
          << "polyhedron, scale " << scale << ", away " << away;
    }
  }
}

TEST(H15_Scale, AClosedBoxKeepsItsLightAtAnyScale) {
  // A ray that slips through a wall finds darkness outside; eight bounces would show it.
  for (Float scale : {Float(1e-4), Float(1e6)}) {
    SceneDesc scene = empty_scene();
    scene.materials = {lambert("wall", Float(0.9))};
    const Transform size = scaling({scale, scale, scale});
    for (const ShapeDesc& wall : inward_box("wall")) scene.shapes.push_back(emitting(moved(wall, size), 1));
    scene.camera.origin = {0, Float(-0.5) * scale, Float(0.1) * scale};
    scene.integrator = {.max_depth = 8, .roulette_depth = 100};
    const Estimate y = estimate_y(render_scene(scene, 256).image);
    const double expected = (1 - std::pow(0.9, 9)) / (1 - 0.9);
    EXPECT_NEAR(y.mean, expected, 4 * y.standard_error + 1e-5 * expected) << scale;
    EXPECT_LT(y.standard_error, 0.01 * expected);
  }
}

TEST(H15_Scale, SpheresWithAHairsBreadthBetweenThemLeakNothing) {
  // A lamp and a screen 4e-5 apart; behind the screen it is dark.
  SceneDesc scene = empty_scene();
  scene.materials = {lambert("black", 0), lambert("white", 1)};
  scene.shapes = {emitting(sphere({0, 0, 0}, 1, "black"), 1), sphere({0, 0, 0}, Float(1.00004), "white"),
                  quad({-5, -5, -2}, {10, 0, 0}, {0, 10, 0}, "white")};
  scene.camera.fov_deg = 60;
  EXPECT_EQ(estimate_y(render_scene(scene, 64).image).mean, 0);
}

TEST(H15_Scale, ACameraAMillionAwaySeesASharpBall) {
  // The silhouette of a unit ball from 1e6: inside white, outside black, no speckle.
  SceneDesc scene = empty_scene();
  scene.film = {64, 64};
  scene.materials = {lambert("white", 1)};
  scene.shapes = {sphere({0, 0, 0}, 1, "white")};
  scene.lights = {sky(1)};
  scene.camera.origin = {0, Float(-1e6), 0};
  scene.camera.fov_deg = Float(4 / 1e6 * 57.2957795);
  const Image image = render_scene(scene, 64).image;
  const auto diffuse = image.find_channel("diffuse.G"), background = image.find_channel("background.G");
  ASSERT_TRUE(diffuse && background);
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      const double r = std::hypot(x - 31.5, y - 31.5) / 16;
      // 0.1: directions are floats; 6e-8 of a million is 0.06.
      const std::size_t absent = r < 1 ? *background : *diffuse;
      if (std::abs(r - 1) > 0.15) {
        EXPECT_EQ(image.at(x, y, absent), 0) << x << ", " << y;
      }
    }
  }
}

/// Rays from random places inside a closed ball of triangles to the points `t` of its edges: how many get
/// out?
struct Misses {
  std::size_t rays = 0, missed = 0;
};
template <typename PlaceOnEdge>
Misses escape(int repeats, PlaceOnEdge place_on_edge) {
  SceneDesc desc = empty_scene();
  desc.materials = {lambert("grey", Float(0.5))};
  const MeshDesc mesh = polyhedral_sphere(40, 80);
  desc.shapes = {{.where = "", .kind = mesh, .material = "grey"}};
  SilentProgress progress;
  const Scene scene = build_scene(desc, progress);
  std::mt19937 random(2);
  std::uniform_real_distribution<double> uniform;
  Misses result;
  for (int repeat = 0; repeat < repeats; ++repeat) {
    for (const auto& triangle : mesh.triangles) {
      const Vec3 a = mesh.positions[triangle[0]], b = mesh.positions[triangle[1]];
      const Float t = place_on_edge(uniform(random));
      const Vec3 target = a * (1 - t) + b * t;
      const Vec3 origin{Float(uniform(random) - 0.5), Float(uniform(random) - 0.5),
                        Float(uniform(random) - 0.5)};
      result.missed += scene.accel.occluded({origin, target - origin}) ? 0 : 1;
      ++result.rays;
    }
  }
  return result;
}

TEST(H16_SharedEdges, RaysDoNotSlipThrough) {
  // Embree tests its robust mode for 2e-5.
  const Misses edges = escape(20, [](double u) { return Float(u); });
  EXPECT_LE(double(edges.missed), 2e-5 * double(edges.rays)) << edges.missed << " of " << edges.rays;
}

TEST(H16_SharedEdges, RaysAtTheVeryVerticesMostlyHit) {
  // Embree decides each edge by itself: around a vertex all may say "outside". Seen: 36 of 6240 (0.6 %);
  // no random ray meets a vertex to the last bit, so what counts is that edges hold.
  const Misses vertices = escape(2, [](double) { return Float(0); });
  EXPECT_LE(double(vertices.missed), 0.02 * double(vertices.rays))
      << vertices.missed << " of " << vertices.rays;
}

TEST(H16_SharedEdges, AGridOfRaysOverAGridOfTrianglesMissesNothing) {
  // Straight down on every vertex and edge of hilly ground.
  constexpr int kSize = 64;
  MeshDesc ground;
  for (int y = 0; y <= kSize; ++y) {
    for (int x = 0; x <= kSize; ++x)
      ground.positions.push_back({Float(x), Float(y), Float(std::sin(x * 0.3 + y))});
  }
  for (std::uint32_t y = 0; y < kSize; ++y) {
    for (std::uint32_t x = 0; x < kSize; ++x) {
      const std::uint32_t i = y * (kSize + 1) + x;
      ground.triangles.push_back({i, i + 1, i + kSize + 2});
      ground.triangles.push_back({i, i + kSize + 2, i + kSize + 1});
    }
  }
  SceneDesc desc = empty_scene();
  desc.materials = {lambert("grey", Float(0.5))};
  desc.shapes = {{.where = "", .kind = ground, .material = "grey"}};
  SilentProgress progress;
  const Scene scene = build_scene(desc, progress);
  std::size_t rays = 0, missed = 0;
  for (int y = 1; y < 4 * kSize; ++y) {
    for (int x = 1; x < 4 * kSize; ++x, ++rays) {
      missed += scene.accel.occluded({{Float(x) / 4, Float(y) / 4, 100}, {0, 0, -1}}) ? 0 : 1;
    }
  }
  EXPECT_LE(double(missed), 2e-5 * double(rays)) << missed << " of " << rays;
}

}  // namespace
}  // namespace spectrace::test
