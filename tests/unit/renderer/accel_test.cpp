// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "renderer/accel_embree.h"
#include "renderer/geometry.h"

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

}  // namespace
}  // namespace spectrace
