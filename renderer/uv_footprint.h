// SPDX-License-Identifier: Apache-2.0
// Where a cone of rays meets a surface: the part of its textures that is seen (ADR 0013).
#pragma once

#include "core/image/footprint.h"
#include "core/math/math.h"
#include "renderer/accel_embree.h"
#include "renderer/geometry.h"
#include "renderer/ray_cone.h"
#include "renderer/surface.h"

namespace spectrace {

namespace detail {

/// How a point moves as its texture coordinates grow; zero where they have no place.
struct UvDerivatives {
  Vec3 u, v;
};

/// `normal`: unit, from the centre.
inline UvDerivatives uv_derivatives(const Sphere& sphere, Vec3 normal) {
  const Float ring = std::sqrt(sqr(normal.x) + sqr(normal.y));
  if (!(ring > 0)) return {};
  const Vec3 up{-normal.z * normal.x / ring, -normal.z * normal.y / ring, ring};
  return {Vec3{-normal.y, normal.x, 0} * (2 * kPi * sphere.radius), up * (kPi * sphere.radius)};
}

inline UvDerivatives uv_derivatives(const Quad& quad) { return {quad.edge_u, quad.edge_v}; }

inline UvDerivatives uv_derivatives(const Disk& disk, Float x, Float y) {
  const Float r = std::sqrt(x * x + y * y);
  if (!(r > 0)) return {};
  return {(disk.edge_v * x - disk.edge_u * y) * (2 * kPi), (disk.edge_u * x + disk.edge_v * y) * (-1 / r)};
}

inline UvDerivatives uv_derivatives(const TriangleMesh& mesh, std::uint32_t primitive) {
  const auto [a, b, c] = mesh.triangles[primitive];
  const Vec3 e1 = mesh.positions[b] - mesh.positions[a], e2 = mesh.positions[c] - mesh.positions[a];
  if (mesh.uvs.empty()) return {e1, e2};
  const Vec2 t0 = mesh.uvs[a], t1 = mesh.uvs[b], t2 = mesh.uvs[c];
  const Float u1 = t1.x - t0.x, v1 = t1.y - t0.y, u2 = t2.x - t0.x, v2 = t2.y - t0.y;
  const Float determinant = u1 * v2 - u2 * v1;
  if (determinant == 0) return {};
  return {(e1 * v2 - e2 * v1) / determinant, (e2 * u1 - e1 * u2) / determinant};
}

inline UvDerivatives local_derivatives(const Shape& shape, const Intersection& hit, Vec3 local_position) {
  if (const auto* sphere = std::get_if<Sphere>(&shape.geometry)) {
    return uv_derivatives(*sphere, (local_position - sphere->center) / sphere->radius);
  }
  if (const auto* quad = std::get_if<Quad>(&shape.geometry)) return uv_derivatives(*quad);
  if (const auto* mesh = std::get_if<TriangleMesh>(&shape.geometry)) {
    return uv_derivatives(*mesh, hit.primitive);
  }
  static_assert(std::variant_size_v<decltype(Shape::geometry)> == 4,
                "a kind of shape without its derivatives");
  return uv_derivatives(std::get<Disk>(shape.geometry), hit.u, hit.v);
}

/// The step of the coordinates that moves a point by `step`, a vector in the plane of both derivatives.
inline Vec2 uv_step(const UvDerivatives& d, Vec3 step) {
  const Float uu = dot(d.u, d.u), uv = dot(d.u, d.v), vv = dot(d.v, d.v);
  const Float determinant = uu * vv - uv * uv;
  const Float along_u = dot(step, d.u), along_v = dot(step, d.v);
  const Vec2 result{(vv * along_u - uv * along_v) / determinant, (uu * along_v - uv * along_u) / determinant};
  return std::isfinite(result.x) && std::isfinite(result.y) ? result : Vec2{};
}

}  // namespace detail

/// The circle of the cone across `direction` (unit) falls on the surface as an ellipse, longer along
/// the direction by 1 / cosine, at most kLongestFootprint.
template <SurfaceQuery kQuery>
Footprint uv_footprint(const Geometry& geometry, const Intersection& hit, const SurfacePoint& point,
                       Vec3 direction, const RayCone& cone) {
  const Shape& shape = geometry.shapes[hit.shape];
  if (!shape.needs_uv) return {};
  const Instance* instance = nullptr;
  if constexpr (kQuery.instances) {
    if (hit.instance != kNone) instance = &geometry.instances[hit.instance];
  }
  const Vec3 local = instance == nullptr ? point.position : instance->to_local.point(point.position);
  detail::UvDerivatives derivatives = detail::local_derivatives(shape, hit, local);
  if (instance != nullptr) {
    derivatives = {instance->to_world.vector(derivatives.u), instance->to_world.vector(derivatives.v)};
  }
  const Frame frame = frame_along(point.normal_g, direction);  // s: the direction's part in the surface
  const Float cosine = std::abs(dot(direction, point.normal_g));
  const Float longer = std::min(1 / cosine, kLongestFootprint);
  return {detail::uv_step(derivatives, frame.s * (cone.width * longer)),
          detail::uv_step(derivatives, frame.t * cone.width)};
}

}  // namespace spectrace
