// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <set>

#include "renderer/accel_embree.h"
#include "renderer/geometry.h"
#include "renderer/surface.h"

namespace spectrace {
namespace {

Shape sphere_at(Float x) { return Shape{.geometry = Sphere{{x, 0, 0}, 1}}; }

// A group's shapes come before the world's own: a hit of either must name the shape that was hit.
TEST(Accel, HitsNameTheirShapeBesideGroups) {
  Geometry geometry;
  geometry.shapes = {sphere_at(0), sphere_at(3), sphere_at(20), sphere_at(30)};
  geometry.groups = {{0, 2}};
  geometry.top = {2, 4};
  Transform moved;
  moved.m[0][3] = 50;
  Transform back;
  back.m[0][3] = -50;
  geometry.instances.push_back({0, moved, back, false});
  const Accel accel(geometry);
  const auto hit_at = [&](Float x) { return accel.intersect(Ray{{x, -10, 0}, {0, 1, 0}}); };

  EXPECT_FALSE(hit_at(0).has_value());  // groups are not seen by themselves
  for (const auto& [x, shape] : {std::pair<Float, std::uint32_t>{20, 2}, {30, 3}}) {
    ASSERT_TRUE(hit_at(x).has_value());
    EXPECT_EQ(hit_at(x)->shape, shape);
    EXPECT_EQ(hit_at(x)->instance, kNone);
  }
  for (const auto& [x, shape] : {std::pair<Float, std::uint32_t>{50, 0}, {53, 1}}) {
    ASSERT_TRUE(hit_at(x).has_value());
    EXPECT_EQ(hit_at(x)->shape, shape);
    EXPECT_EQ(hit_at(x)->instance, 0U);
  }
}

Geometry one_of_each_kind() {
  Geometry geometry;
  TriangleMesh hill;
  hill.positions = {{-3, -3, 0}, {3, -3, 0}, {3, 3, 0}, {-3, 3, 0}, {0, 0, 1}};
  hill.triangles = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
  geometry.shapes = {sphere_at(0), sphere_at(2), Shape{.geometry = hill},
                     Shape{.geometry = Quad{{-9, -9, -2}, {18, 0, 0}, {0, 18, 0}}},
                     Shape{.geometry = Disk{{-2, 0, 2}, {1, 0, 0}, {0, 1, 0}}}};
  geometry.groups = {{0, 1}};
  geometry.top = {1, 5};
  Transform up, down;
  up.m[2][3] = 4;
  down.m[2][3] = -4;
  geometry.instances.push_back({0, up, down, false});
  return geometry;
}

/// Embree is given two triangles of each: what comes back is the quad's own u and v on either.
TEST(Accel, QuadsAreOnePrimitiveWithTheirOwnCoordinates) {
  const Quad quad{{1, 2, 3}, {4, 0, 1}, {0, 3, 0}};
  Geometry geometry;
  geometry.shapes = {Shape{.geometry = quad}};
  geometry.top = {0, 1};
  const Accel accel(geometry);
  constexpr int kSteps = 16;
  for (int i = 0; i < kSteps; ++i) {
    for (int j = 0; j < kSteps; ++j) {
      const Float u = (Float(i) + Float(0.5)) / kSteps, v = (Float(j) + Float(0.25)) / kSteps;
      const Vec3 point = quad.corner + quad.edge_u * u + quad.edge_v * v;
      const auto hit = accel.intersect(Ray{point + Vec3{0, 0, 5}, {0, 0, -1}});
      ASSERT_TRUE(hit.has_value()) << u << ' ' << v;
      EXPECT_EQ(hit->primitive, 0U);
      EXPECT_NEAR(hit->u, u, 1e-6);
      EXPECT_NEAR(hit->v, v, 1e-6);
    }
  }
}

TEST(Accel, PacketsFindWhatSingleRaysFind) {
  const Geometry geometry = one_of_each_kind();
  const Accel accel(geometry);
  std::mt19937 random(3);
  std::uniform_real_distribution<float> uniform(-1, 1);
  const auto any = [&](Float size) {
    return Vec3{size * uniform(random), size * uniform(random), size * uniform(random)};
  };
  std::size_t hit_count = 0;
  std::set<std::uint32_t> shapes;
  for (int round = 0; round < 500; ++round) {
    RayPacket rays;
    for (Ray& ray : rays)
      ray = {any(6), any(1), round % 3 == 0 ? Float(8) : std::numeric_limits<Float>::infinity()};
    const auto active = PacketMask(random() & 0xffU);
    const bool coherent = round % 2 == 0;  // advice only: what is found does not depend on it
    const Intersection untouched{.t = -7};
    HitPacket hits;
    hits.fill(untouched);
    accel.intersect(rays, active, coherent, hits);
    const PacketMask blocked = accel.occluded(rays, active, coherent);
    EXPECT_EQ(blocked & ~active, 0U);
    for (std::size_t i = 0; i < kPacket; ++i) {
      if ((active >> i & 1U) == 0) {
        EXPECT_EQ(hits[i]->t, untouched.t);
        continue;
      }
      const std::optional<Intersection> single = accel.intersect(rays[i]);
      ASSERT_EQ(hits[i].has_value(), single.has_value());
      EXPECT_EQ((blocked >> i & 1U) != 0, single.has_value());
      if (!single) continue;
      ++hit_count;
      shapes.insert(single->shape);
      EXPECT_EQ(hits[i]->shape, single->shape);
      EXPECT_EQ(hits[i]->primitive, single->primitive);
      EXPECT_EQ(hits[i]->instance, single->instance);
      EXPECT_NEAR(hits[i]->t, single->t, 1e-5 * single->t);  // Embree's packet code rounds in another order
      EXPECT_NEAR(hits[i]->u, single->u, 1e-5);
      EXPECT_NEAR(hits[i]->v, single->v, 1e-5);
    }
  }
  EXPECT_GT(hit_count, 500U);
  EXPECT_EQ(shapes.size(), geometry.shapes.size());
}

TEST(Accel, DisksAreHitWithinTheirRimAndNowhereElse) {
  Geometry geometry;
  // An ellipse of half axes 2 and 1, in a plane through z = 3 tilted by 45 degrees about x.
  geometry.shapes = {
      Shape{.geometry = Disk{{0, 0, 3}, {2, 0, 0}, {0, std::sqrt(Float(0.5)), std::sqrt(Float(0.5))}}}};
  geometry.top = {0, 1};
  const Accel accel(geometry);
  const auto hit_at = [&](Float x, Float y) { return accel.intersect(Ray{{x, y, 10}, {0, 0, -2}}); };
  for (double turn = 0; turn < 6.2; turn += 0.3) {
    for (double r : {0.0, 0.5, 0.9999, 1.0001, 1.2}) {
      const auto x = Float(2 * r * std::cos(turn)), y = Float(r * std::sqrt(0.5) * std::sin(turn));
      const auto hit = hit_at(x, y);
      ASSERT_EQ(hit.has_value(), r < 1) << r << ' ' << turn;
      EXPECT_EQ(accel.occluded(Ray{{x, y, 10}, {0, 0, -2}}), r < 1);
      if (!hit) continue;
      EXPECT_NEAR(hit->t, (7 - double(y)) / 2, 1e-5);  // z = 3 + y
      EXPECT_NEAR(hit->u, r * std::cos(turn), 1e-5);
      EXPECT_NEAR(hit->v, r * std::sin(turn), 1e-5);
      const SurfacePoint point = surface_point<SurfaceQuery{}>(geometry, Ray{{x, y, 10}, {0, 0, -2}}, *hit);
      EXPECT_NEAR(length(point.position - Vec3{x, y, 3 + y}), 0, 1e-5);
      EXPECT_NEAR(point.normal_g.z, std::sqrt(0.5), 1e-6);
      EXPECT_NEAR(point.uv.y, 1 - r, 1e-5);
      EXPECT_NEAR(point.uv.x, r > 0 ? turn / (2 * kPi64) : 0, 1e-5);
      EXPECT_NEAR(dot(point.tangent, point.normal_g), 0, 1e-6);
    }
  }
  EXPECT_FALSE(accel.intersect(Ray{{-5, 0, 3}, {1, 0, 0}}));      // along its plane
  EXPECT_FALSE(accel.intersect(Ray{{0, 0, 10}, {0, 0, -1}, 6}));  // ends before it
  EXPECT_FALSE(accel.intersect(Ray{{0, 0, 0}, {0, 0, -1}}));      // away from it
}

TEST(Surface, CoordinatesOfADiskAreMirroredOnlyWhereTheDiskIs) {
  Geometry geometry;
  geometry.shapes = {Shape{.geometry = Disk{{0, 0, 0}, {2, 0, 0}, {0, 1, 0}}}};
  geometry.top = {0, 1};
  const Float step = Float(1e-3);
  for (bool mirrored : {false, true}) {
    std::get<Disk>(geometry.shapes[0].geometry).mirrored = mirrored;
    const auto at = [&](Float x, Float y) {
      return surface_point<SurfaceQuery{}>(geometry, Ray{}, Intersection{.t = 1, .u = x, .v = y});
    };
    const SurfacePoint point = at(Float(0.3), Float(0.5));
    EXPECT_EQ(point.normal_g.z, mirrored ? -1 : 1);
    // Along the tangent u grows and v stays, to first order; towards the centre v grows.
    const Vec3 way = normalize(point.tangent) * step;
    const SurfacePoint along = at(Float(0.3) + way.x / 2, Float(0.5) + way.y);
    EXPECT_GT(along.uv.x, point.uv.x);
    EXPECT_NEAR(along.uv.y, point.uv.y, 1e-5);
    const Vec3 inwards = cross(point.normal_g, point.tangent) * point.v_sign;
    EXPECT_LT(dot(inwards, Vec3{Float(0.6), Float(0.5), 0}), 0);
  }
}

}  // namespace
}  // namespace spectrace
