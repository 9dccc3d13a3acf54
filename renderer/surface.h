// SPDX-License-Identifier: Apache-2.0
// From a ray's hit to the point shading needs: position, normals, texture coordinates, rounding bound.
#pragma once

#include "core/math/math.h"
#include "renderer/accel_embree.h"
#include "renderer/geometry.h"

namespace spectrace {

struct SurfacePoint {
  Vec3 position;
  Vec3 normal_g;  ///< geometric, unit, out of the front
  Vec3 normal_s;  ///< shading, unit, on normal_g's side
  Vec3 tangent;   ///< ∂p/∂u, any length, maybe zero
  Vec2 uv;
  Float v_sign = 1;  ///< 1 where v grows along normal_g x tangent, -1 where it is mirrored
  Float error = 0;   ///< how far along normal_g a new ray must start to leave the surface behind
  std::uint32_t material = 0;
  std::uint32_t light = kNone;  ///< area light, if it emits
};

/// What a kernel may leave out. What is left out must not change what remains.
struct SurfaceQuery {
  bool instances = true;
  bool uv = true;
};

/// Steps of float rounding, relative to the largest coordinate involved, that a new ray starts off the
/// surface. Position from barycentric weights: 4; Embree's distance to a plane through vertices moved to the
/// ray's origin: about 6; the offset itself: 1. Doubled, since those are estimates.
/// tests/hard_cases/rays_test.cpp finds self-hits at 4.
inline constexpr Float kOffsetSteps = 24;
inline constexpr Float kFloatRounding = Float(0x1p-24);  // Embree computes in float whatever Float is

namespace detail {

/// Squared lengths between this and its inverse are far from the ends of what a float holds: nothing that
/// went into them has been lost below.
inline constexpr Float kSafeSquare = Float(1e-20);

/// normalize() for vectors whose squared length would underflow or overflow.
inline Vec3 normalize_any(Vec3 v) { return normalize(v / max_abs(v)); }
inline Vec3 triangle_normal(Vec3 edge_1, Vec3 edge_2) {
  const Vec3 n = cross(edge_1, edge_2);
  const Float l2 = length_squared(n);
  if (l2 > kSafeSquare && l2 < 1 / kSafeSquare) return n / std::sqrt(l2);
  return normalize_any(cross(edge_1 / max_abs(edge_1), edge_2 / max_abs(edge_2)));
}

struct LocalPoint {
  SurfacePoint surface;
  Float magnitude = 0;  // largest coordinate that took part
};

/// `t_rest`: what Embree's t, a float, is too coarse to hold far from the origin (hard case H15).
inline LocalPoint sphere_point(const Sphere& sphere, const Ray& ray, Float t, Float t_rest, bool want_uv) {
  const double t_exact = double(t) + double(t_rest);
  const auto offset = [&](Float o, Float d, Float c) { return double(o) + t_exact * double(d) - double(c); };
  const double x = offset(ray.origin.x, ray.direction.x, sphere.center.x);
  const double y = offset(ray.origin.y, ray.direction.y, sphere.center.y);
  const double z = offset(ray.origin.z, ray.direction.z, sphere.center.z);
  const double scale = 1 / std::sqrt(x * x + y * y + z * z);
  LocalPoint point;
  SurfacePoint& s = point.surface;
  s.normal_g = {Float(x * scale), Float(y * scale), Float(z * scale)};
  s.normal_s = s.normal_g;
  s.position = sphere.center + s.normal_g * sphere.radius;
  s.tangent = {-s.normal_g.y, s.normal_g.x, 0};
  if (want_uv) {
    const Float turn = std::atan2(s.normal_g.y, s.normal_g.x) * (kInvPi / 2);
    s.uv = {turn < 0 ? turn + 1 : turn, 1 - safe_acos(s.normal_g.z) * kInvPi};
  }
  point.magnitude = max_abs(sphere.center) + sphere.radius;
  return point;
}

inline LocalPoint quad_point(const Quad& quad, Float u, Float v) {
  LocalPoint point;
  SurfacePoint& s = point.surface;
  s.position = quad.corner + quad.edge_u * u + quad.edge_v * v;
  s.normal_g = triangle_normal(quad.edge_u, quad.mirrored ? -quad.edge_v : quad.edge_v);
  s.normal_s = s.normal_g;
  s.tangent = quad.edge_u;
  s.v_sign = quad.mirrored ? Float(-1) : Float(1);
  s.uv = {u, v};
  point.magnitude = largest_coordinate(quad);
  return point;
}

/// `x` and `y` along the edges. u is the angle from edge_u in turns, v falls from 1 at the centre to 0 at the
/// rim: so that u and v are not mirrored seen from the front.
inline LocalPoint disk_point(const Disk& disk, Float x, Float y, bool want_uv) {
  LocalPoint point;
  SurfacePoint& s = point.surface;
  s.position = disk.center + disk.edge_u * x + disk.edge_v * y;
  s.normal_g = triangle_normal(disk.edge_u, disk.mirrored ? -disk.edge_v : disk.edge_v);
  s.normal_s = s.normal_g;
  const bool is_center = x == 0 && y == 0;
  s.tangent = is_center ? disk.edge_v : disk.edge_v * x - disk.edge_u * y;
  s.v_sign = disk.mirrored ? Float(-1) : Float(1);
  if (want_uv) {
    const Float turn = is_center ? 0 : std::atan2(y, x) * (kInvPi / 2);
    s.uv = {turn < 0 ? turn + 1 : turn, 1 - safe_sqrt(x * x + y * y)};
  }
  point.magnitude = largest_coordinate(disk);
  return point;
}

inline LocalPoint triangle_point(const TriangleMesh& mesh, std::uint32_t primitive, Float u, Float v,
                                 bool want_uv) {
  const auto [a, b, c] = mesh.triangles[primitive];
  const Vec3 p0 = mesh.positions[a], p1 = mesh.positions[b], p2 = mesh.positions[c];
  const Float w = 1 - u - v;
  LocalPoint point;
  SurfacePoint& s = point.surface;
  s.position = p0 * w + p1 * u + p2 * v;
  s.normal_g = triangle_normal(p1 - p0, p2 - p0);
  s.normal_s = s.normal_g;
  if (!mesh.normals.empty()) {
    const Vec3 n0 = mesh.normals[a], n1 = mesh.normals[b], n2 = mesh.normals[c];
    const Vec3 n = n0 * w + n1 * u + n2 * v;
    const Float l2 = length_squared(n);
    if (n0 != Vec3{} && n1 != Vec3{} && n2 != Vec3{} && l2 > 0) {
      s.normal_s = n / std::sqrt(l2);
      // Which side is the front is the winding's to say; a file's normals only bend it.
      if (dot(s.normal_s, s.normal_g) < 0) s.normal_s = -s.normal_s;
    }
  }
  s.tangent = p1 - p0;
  if (!mesh.uvs.empty()) {
    const Vec2 t0 = mesh.uvs[a], t1 = mesh.uvs[b], t2 = mesh.uvs[c];
    const Float v1 = t1.y - t0.y, v2 = t2.y - t0.y;
    const Float determinant = (t1.x - t0.x) * v2 - (t2.x - t0.x) * v1;
    if (determinant != 0) {
      s.v_sign = std::copysign(Float(1), determinant);
      s.tangent = ((p1 - p0) * v2 - (p2 - p0) * v1) * s.v_sign;
    }
    if (want_uv) s.uv = {t0.x * w + t1.x * u + t2.x * v, t0.y * w + t1.y * u + t2.y * v};
  } else {
    s.uv = {u, v};
  }
  point.magnitude = std::max({max_abs(p0), max_abs(p1), max_abs(p2)});
  return point;
}

inline Float largest_row(const Transform& t) {
  Float largest = 0;
  for (const auto& row : t.m) {
    largest = std::max(largest, std::abs(row[0]) + std::abs(row[1]) + std::abs(row[2]));
  }
  return largest;
}

inline void move_to_world(const Instance& instance, LocalPoint& point) {
  const Transform& m = instance.to_world;
  SurfacePoint& s = point.surface;
  const Float side = instance.mirrored ? Float(-1) : Float(1);
  s.position = m.point(s.position);
  s.normal_g = normalize_any(m.normal(s.normal_g) * side);
  s.normal_s = normalize_any(m.normal(s.normal_s) * side);
  s.tangent = m.vector(s.tangent);
  s.v_sign *= side;
  // Embree moves the ray's origin into the group's space: its rounding there comes back scaled up.
  const Vec3 offset_local{instance.to_local.m[0][3], instance.to_local.m[1][3], instance.to_local.m[2][3]};
  const Float origin_local = largest_row(instance.to_local) * max_abs(s.position) + max_abs(offset_local);
  point.magnitude = largest_row(m) * (point.magnitude + origin_local) + max_abs(s.position);
}

}  // namespace detail

template <SurfaceQuery kQuery>
SurfacePoint surface_point(const Geometry& geometry, const Ray& ray, const Intersection& hit) {
  const Shape& shape = geometry.shapes[hit.shape];
  const bool want_uv = kQuery.uv && shape.needs_uv;
  const Instance* instance = nullptr;
  if constexpr (kQuery.instances) {
    if (hit.instance != kNone) instance = &geometry.instances[hit.instance];
  }
  detail::LocalPoint point;
  if (const auto* sphere = std::get_if<Sphere>(&shape.geometry)) {
    const Ray local = instance == nullptr ? ray
                                          : Ray{instance->to_local.point(ray.origin),
                                                instance->to_local.vector(ray.direction)};
    point = detail::sphere_point(*sphere, local, hit.t, hit.u, want_uv);
  } else if (const auto* quad = std::get_if<Quad>(&shape.geometry)) {
    point = detail::quad_point(*quad, hit.u, hit.v);
  } else if (const auto* mesh = std::get_if<TriangleMesh>(&shape.geometry)) {
    point = detail::triangle_point(*mesh, hit.primitive, hit.u, hit.v, want_uv);
  } else {
    point = detail::disk_point(std::get<Disk>(shape.geometry), hit.u, hit.v, want_uv);
    static_assert(std::variant_size_v<decltype(Shape::geometry)> == 4, "a kind of shape without its point");
  }
  if (instance != nullptr) {
    detail::move_to_world(*instance, point);
  }
  SurfacePoint& s = point.surface;
  s.error = kOffsetSteps * kFloatRounding * point.magnitude;
  s.material = shape.material;
  if (shape.first_light != kNone) s.light = shape.first_light + hit.primitive;
  return s;
}

/// Where a ray that leaves `point` towards `direction` starts: off the surface, on the side it goes.
inline Vec3 ray_origin(const SurfacePoint& point, Vec3 direction) {
  return point.position + point.normal_g * (dot(direction, point.normal_g) < 0 ? -point.error : point.error);
}

/// Frame around a unit normal with s along the tangent's part across it, if it has one.
inline Frame frame_along(Vec3 normal, Vec3 tangent) {
  const Vec3 across = tangent - normal * dot(normal, tangent);
  const Float l2 = length_squared(across);
  // 1e-6: a tangent within a thousandth of the normal has lost half its digits.
  if (!(l2 > Float(1e-6) * length_squared(tangent)) || !std::isfinite(l2)) {
    return Frame::from_normal(normal);
  }
  const Vec3 s = across / std::sqrt(l2);
  return {s, cross(normal, s), normal};
}

}  // namespace spectrace
