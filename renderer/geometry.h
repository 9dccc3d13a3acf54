// SPDX-License-Identifier: Apache-2.0
// The shapes of a built scene as plain data: what the acceleration structure copies and hits refer to.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <variant>
#include <vector>

#include "core/math/math.h"
#include "core/math/vec.h"

namespace spectrace {

inline constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

[[nodiscard]] inline Float max_abs(Vec3 v) {
  return std::max(std::abs(v.x), std::max(std::abs(v.y), std::abs(v.z)));
}

struct Ray {
  Vec3 origin;
  Vec3 direction;  ///< any length but zero; distances are in its units
  Float t_max = std::numeric_limits<Float>::infinity();
};

/// Outward normal = front.
struct Sphere {
  Vec3 center;
  Float radius = 1;
};

/// The parallelogram corner + [0,1] edge_u + [0,1] edge_v; front: edge_u x edge_v, or against it where
/// `mirrored` (a reflection of the scene keeps fronts in front).
struct Quad {
  Vec3 corner, edge_u, edge_v;
  bool mirrored = false;

  [[nodiscard]] Vec3 scaled_normal() const {  ///< its length is the area
    const Vec3 n = cross(edge_u, edge_v);
    return mirrored ? -n : n;
  }
};

/// Of its four corners.
[[nodiscard]] inline Float largest_coordinate(const Quad& q) {
  return std::max({max_abs(q.corner), max_abs(q.corner + q.edge_u), max_abs(q.corner + q.edge_v),
                   max_abs(q.corner + q.edge_u + q.edge_v)});
}

/// The filled ellipse center + x edge_u + y edge_v, x² + y² <= 1: an affine map leaves a disk one of these.
/// Front as a quad's.
struct Disk {
  Vec3 center, edge_u, edge_v;
  bool mirrored = false;

  [[nodiscard]] Vec3 scaled_normal() const {  ///< its length is the area
    const Vec3 n = cross(edge_u, edge_v) * kPi;
    return mirrored ? -n : n;
  }
  /// Of the smallest box around it: half its sides.
  [[nodiscard]] Vec3 half_extent() const {
    return {std::hypot(edge_u.x, edge_v.x), std::hypot(edge_u.y, edge_v.y), std::hypot(edge_u.z, edge_v.z)};
  }
};

[[nodiscard]] inline Float largest_coordinate(const Disk& d) {
  return max_abs(d.center) + max_abs(d.half_extent());
}

/// Counter-clockwise triangles seen from the front.
struct TriangleMesh {
  std::vector<Vec3> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<Vec3> normals;  ///< per position, unit or zero (none); empty: flat
  std::vector<Vec2> uvs;      ///< per position; empty: barycentric
};

struct Shape {
  std::variant<Sphere, Quad, TriangleMesh, Disk> geometry;
  std::uint32_t material = 0;
  std::uint32_t first_light = kNone;  ///< area light of primitive 0; the others follow
  bool needs_uv = true;               ///< its material varies over the surface
  std::uint32_t object = 0;           ///< which of the scene file's shapes it is, or a part of; 0 in groups
};

/// A group under one more transform.
struct Instance {
  std::uint32_t group = 0;
  Transform to_world, to_local;  ///< inverses of each other
  bool mirrored = false;         ///< is_mirroring(to_world)
  std::uint32_t object = 0;      ///< which of the scene file's shapes it is
};

struct ShapeRange {
  std::uint32_t begin = 0, end = 0;
};

/// `shapes[top]` and `instances` make the world; each group is a range of shapes of its own.
struct Geometry {
  std::vector<Shape> shapes;
  ShapeRange top;
  std::vector<ShapeRange> groups;
  std::vector<Instance> instances;
};

struct Box {
  Vec3 min{std::numeric_limits<Float>::infinity(), std::numeric_limits<Float>::infinity(),
           std::numeric_limits<Float>::infinity()};
  Vec3 max = -min;

  void add(Vec3 p);
  [[nodiscard]] bool empty() const { return !(min.x <= max.x); }
  [[nodiscard]] Vec3 center() const { return (min + max) * Float(0.5); }
  [[nodiscard]] Float radius() const { return empty() ? 0 : length(max - min) * Float(0.5); }
};

[[nodiscard]] Box bounds(const Shape& shape);
[[nodiscard]] Box bounds(const Geometry& geometry);

/// Both crossings of a line with a sphere, near first, in units of the direction; in double, by the distance
/// of the line from the centre: no cancellation however far the origin (hard case H15).
struct SphereCrossings {
  double near = 0, far = 0;
};
[[nodiscard]] std::optional<SphereCrossings> intersect_sphere(const Sphere& sphere, const Ray& ray);

/// Where a line crosses a disk, in double; nullopt where it misses it or runs along its plane.
struct DiskCrossing {
  double t = 0;         ///< in units of the direction
  double x = 0, y = 0;  ///< along the disk's edges
};
[[nodiscard]] std::optional<DiskCrossing> intersect_disk(const Disk& disk, const Ray& ray);

/// The inverse map, in double inside; nullopt where the determinant is 0 or not finite.
[[nodiscard]] std::optional<Transform> inverse(const Transform& transform);

/// Does it turn left into right? Sign of the determinant, in double.
[[nodiscard]] bool is_mirroring(const Transform& transform);

}  // namespace spectrace
