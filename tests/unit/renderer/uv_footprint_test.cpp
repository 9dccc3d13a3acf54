// SPDX-License-Identifier: Apache-2.0
#include "renderer/uv_footprint.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "renderer/camera.h"

namespace spectrace {
namespace {

constexpr SurfaceQuery kAll{};

struct Seen {
  Footprint footprint;
  Vec2 uv;
};

Seen see(const Geometry& geometry, const Accel& accel, const Ray& ray, Float width) {
  const std::optional<Intersection> hit = accel.intersect(ray);
  EXPECT_TRUE(hit);
  const SurfacePoint point = surface_point<kAll>(geometry, ray, *hit);
  return {uv_footprint<kAll>(geometry, *hit, point, ray.direction, RayCone{width, 0}), point.uv};
}

/// Parallel rays half a width beside the first, along the ellipse's axes, meet it at the ends of the axes.
void expect_true_to_rays(const Geometry& geometry, const Ray& ray, const std::string& what) {
  const Accel accel(geometry);
  constexpr Float kWidth = Float(2e-2);  // uv differ in their third digit; curvature shows in the next
  const Seen seen = see(geometry, accel, ray, kWidth);
  const std::optional<Intersection> hit = accel.intersect(ray);
  const SurfacePoint point = surface_point<kAll>(geometry, ray, *hit);
  const Vec3 across = normalize(cross(point.normal_g, ray.direction));
  const Vec3 along = normalize(cross(across, ray.direction));
  const auto expect_axis = [&](Vec3 side, Vec2 axis, const char* name) {
    const Seen plus = see(geometry, accel, {ray.origin + side * (kWidth / 2), ray.direction}, kWidth);
    const Seen minus = see(geometry, accel, {ray.origin - side * (kWidth / 2), ray.direction}, kWidth);
    const Vec2 seen_axis{plus.uv.x - minus.uv.x, plus.uv.y - minus.uv.y};
    const Float sign = seen_axis.x * axis.x + seen_axis.y * axis.y < 0 ? Float(-1) : Float(1);
    const Float size = std::hypot(axis.x, axis.y);
    EXPECT_GT(size, 0);
    EXPECT_NEAR(seen_axis.x, sign * axis.x, 0.02 * size) << what << ' ' << name;
    EXPECT_NEAR(seen_axis.y, sign * axis.y, 0.02 * size) << what << ' ' << name;
  };
  expect_axis(along, seen.footprint.major, "major");
  expect_axis(across, seen.footprint.minor, "minor");
}

Geometry geometry_of(Shape shape) {
  shape.needs_uv = true;
  Geometry geometry;
  geometry.shapes = {std::move(shape)};
  geometry.top = {0, 1};
  return geometry;
}

Ray towards(Vec3 target, Vec3 from) { return {from, normalize(target - from)}; }

TEST(UvFootprint, IsWhereTheRaysOfTheConeMeetTheSurface) {
  const Quad quad{{-2, -1, 0}, {3, 1, 0}, {Float(-0.5), 2, Float(0.3)}};
  expect_true_to_rays(geometry_of({.geometry = quad}), towards({0, Float(0.3), Float(0.1)}, {2, 3, 4}),
                      "quad");
  expect_true_to_rays(geometry_of({.geometry = Sphere{{1, 2, 0}, 2}}), towards({2, 1, 1}, {5, 0, 4}),
                      "sphere");
  const Disk disk{{0, 0, 1}, {2, 0, 0}, {0, 1, Float(0.2)}};
  expect_true_to_rays(geometry_of({.geometry = disk}),
                      towards({Float(0.6), Float(0.4), Float(1.1)}, {3, 2, 5}), "disk");
  TriangleMesh mesh;
  mesh.positions = {{-1, -1, 0}, {2, -1, 0}, {0, 2, Float(0.5)}};
  mesh.triangles = {{0, 1, 2}};
  expect_true_to_rays(geometry_of({.geometry = mesh}), towards({0, 0, Float(0.2)}, {1, -3, 3}), "triangle");
  mesh.uvs = {{Float(0.1), 2}, {Float(0.9), Float(2.3)}, {Float(0.3), Float(0.5)}};
  expect_true_to_rays(geometry_of({.geometry = mesh}), towards({0, 0, Float(0.2)}, {1, -3, 3}),
                      "mapped triangle");
}

TEST(UvFootprint, FollowsInstances) {
  Geometry geometry = geometry_of({.geometry = Sphere{{0, 0, 0}, 1}});
  geometry.groups = {{0, 1}};
  geometry.top = {1, 1};
  Transform wider, narrower;
  for (std::size_t i = 0; i < 3; ++i) {
    const Float scale = std::array<Float, 3>{3, 1, 2}[i];
    wider.m[i][i] = scale;
    narrower.m[i][i] = 1 / scale;
  }
  wider.m[0][3] = 5;
  narrower.m[0][3] = Float(-5) / 3;
  geometry.instances.push_back({0, wider, narrower, false});
  expect_true_to_rays(geometry, towards({6, Float(-0.5), 1}, {8, -4, 4}), "instance");
}

TEST(UvFootprint, IsBoundedAtGrazingIncidenceAndNoneWhereCoordinatesHaveNoPlace) {
  const Geometry quad = geometry_of({.geometry = Quad{{-1, -1, 0}, {2, 0, 0}, {0, 2, 0}}});
  const Accel accel(quad);
  const Seen grazing = see(quad, accel, towards({0, 0, 0}, {10, 0, Float(0.01)}), Float(0.01));
  EXPECT_NEAR(std::abs(grazing.footprint.major.x), 16 * 0.005, 1e-4);
  EXPECT_NEAR(std::abs(grazing.footprint.minor.y), 0.005, 1e-6);
  const Geometry disk = geometry_of({.geometry = Disk{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}});
  const Seen center = see(disk, Accel(disk), {{0, 0, 1}, {0, 0, -1}}, Float(0.1));
  EXPECT_EQ(center.footprint.major.x, 0);
  EXPECT_EQ(center.footprint.minor.y, 0);
  Geometry plain = quad;
  plain.shapes[0].needs_uv = false;
  EXPECT_EQ(see(plain, accel, {{0, 0, 1}, {0, 0, -1}}, Float(0.1)).footprint.major.x, 0);
}

TEST(RayCone, IsAPixelWide) {
  const CameraDesc description{.origin = {0, 0, 0}, .target = {0, 0, -1}, .fov_deg = 90};
  const FilmDesc film{100, 100};
  const Camera camera(description, film);
  // Neighbouring rays, and how far apart they are at distance 3.
  for (const Vec2 at : {Vec2{50, 50}, Vec2{1, 50}, Vec2{1, 1}}) {
    const Ray ray = camera.ray(at);
    const Float width = camera.cone(ray).at(3).width;
    Float narrowest = 1;
    for (int i = 0; i < 16; ++i) {
      const Float a = Float(i) / 16 * 2 * kPi;
      const Ray beside = camera.ray({at.x + std::cos(a) / 2, at.y + std::sin(a) / 2});
      narrowest = std::min(narrowest, 2 * 3 * length(beside.direction - ray.direction));
    }
    EXPECT_NEAR(width, narrowest, 0.02 * narrowest);
  }
  CameraDesc parallel = description;
  parallel.projection = Projection::kOrthographic;
  parallel.view_size = 2;
  const Camera orthographic(parallel, film);
  EXPECT_NEAR(orthographic.cone(orthographic.ray({3, 4})).at(7).width, 0.02, 1e-6);
}

TEST(RayCone, ShrinksAsSamplesGather) {
  EXPECT_EQ(share_of_pixel(0), 1);
  EXPECT_EQ(share_of_pixel(3), Float(0.5));
  EXPECT_EQ(share_of_pixel(63), Float(0.125));
  EXPECT_EQ(share_of_pixel(4000000000U), Float(0.125));
}

}  // namespace
}  // namespace spectrace
