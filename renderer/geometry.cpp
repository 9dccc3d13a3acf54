// SPDX-License-Identifier: Apache-2.0
#include "renderer/geometry.h"

#include "core/base/overloaded.h"

namespace spectrace {

namespace {

struct DoubleVec {
  double x, y, z;
};
DoubleVec wide(Vec3 v) { return {v.x, v.y, v.z}; }
double dot(DoubleVec a, DoubleVec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
DoubleVec cross(DoubleVec a, DoubleVec b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

}  // namespace

void Box::add(Vec3 p) {
  min = {std::min(min.x, p.x), std::min(min.y, p.y), std::min(min.z, p.z)};
  max = {std::max(max.x, p.x), std::max(max.y, p.y), std::max(max.z, p.z)};
}

Box bounds(const Shape& shape) {
  Box box;
  std::visit(Overloaded{[&](const Sphere& sphere) {
                          const Vec3 r{sphere.radius, sphere.radius, sphere.radius};
                          box.add(sphere.center - r);
                          box.add(sphere.center + r);
                        },
                        [&](const Quad& quad) {
                          box.add(quad.corner);
                          box.add(quad.corner + quad.edge_u);
                          box.add(quad.corner + quad.edge_v);
                          box.add(quad.corner + quad.edge_u + quad.edge_v);
                        },
                        [&](const Disk& disk) {
                          box.add(disk.center - disk.half_extent());
                          box.add(disk.center + disk.half_extent());
                        },
                        [&](const TriangleMesh& mesh) {
                          for (Vec3 p : mesh.positions) box.add(p);
                        }},
             shape.geometry);
  return box;
}

Box bounds(const Geometry& geometry) {
  const auto range_bounds = [&](ShapeRange range) {
    Box box;
    for (std::uint32_t i = range.begin; i < range.end; ++i) {
      const Box b = bounds(geometry.shapes[i]);
      if (!b.empty()) {
        box.add(b.min);
        box.add(b.max);
      }
    }
    return box;
  };
  Box world = range_bounds(geometry.top);
  for (const Instance& instance : geometry.instances) {
    const Box local = range_bounds(geometry.groups[instance.group]);
    if (local.empty()) {
      continue;
    }
    for (int corner = 0; corner < 8; ++corner) {
      world.add(instance.to_world.point({(corner & 1) != 0 ? local.max.x : local.min.x,
                                         (corner & 2) != 0 ? local.max.y : local.min.y,
                                         (corner & 4) != 0 ? local.max.z : local.min.z}));
    }
  }
  return world;
}

std::optional<SphereCrossings> intersect_sphere(const Sphere& sphere, const Ray& ray) {
  const DoubleVec d = wide(ray.direction);
  const DoubleVec o = wide(ray.origin), center = wide(sphere.center);
  const DoubleVec to_center{center.x - o.x, center.y - o.y, center.z - o.z};
  const double dd = dot(d, d);
  const double t_closest = dot(to_center, d) / dd;
  const DoubleVec perpendicular{to_center.x - t_closest * d.x, to_center.y - t_closest * d.y,
                                to_center.z - t_closest * d.z};
  const double radius = sphere.radius;
  const double h2 = radius * radius - dot(perpendicular, perpendicular);
  if (!(h2 >= 0)) {
    return std::nullopt;
  }
  const double half = std::sqrt(h2 / dd);
  return SphereCrossings{t_closest - half, t_closest + half};
}

std::optional<DiskCrossing> intersect_disk(const Disk& disk, const Ray& ray) {
  const DoubleVec d = wide(ray.direction), o = wide(ray.origin), c = wide(disk.center);
  const DoubleVec u = wide(disk.edge_u), v = wide(disk.edge_v);
  const DoubleVec n = cross(u, v), from_center{o.x - c.x, o.y - c.y, o.z - c.z};
  const double t = -dot(from_center, n) / dot(d, n);
  if (!std::isfinite(t)) {
    return std::nullopt;
  }
  const DoubleVec p{from_center.x + t * d.x, from_center.y + t * d.y, from_center.z + t * d.z};
  // Cramer's rule in the plane: p = x u + y v.
  const double nn = dot(n, n);
  const DiskCrossing crossing{t, dot(cross(p, v), n) / nn, dot(cross(u, p), n) / nn};
  if (!(crossing.x * crossing.x + crossing.y * crossing.y <= 1)) {
    return std::nullopt;
  }
  return crossing;
}

bool is_mirroring(const Transform& transform) {
  const auto& m = transform.m;
  return double(m[0][0]) * (double(m[1][1]) * m[2][2] - double(m[1][2]) * m[2][1]) -
             double(m[0][1]) * (double(m[1][0]) * m[2][2] - double(m[1][2]) * m[2][0]) +
             double(m[0][2]) * (double(m[1][0]) * m[2][1] - double(m[1][1]) * m[2][0]) <
         0;
}

std::optional<Transform> inverse(const Transform& transform) {
  const auto& m = transform.m;
  const auto minor2 = [&](int r0, int r1, int c0, int c1) {
    return double(m[r0][c0]) * m[r1][c1] - double(m[r0][c1]) * m[r1][c0];
  };
  const double c00 = minor2(1, 2, 1, 2), c01 = -minor2(1, 2, 0, 2), c02 = minor2(1, 2, 0, 1);
  const double determinant = m[0][0] * c00 + m[0][1] * c01 + m[0][2] * c02;
  const double cofactor[3][3] = {{c00, c01, c02},
                                 {-minor2(0, 2, 1, 2), minor2(0, 2, 0, 2), -minor2(0, 2, 0, 1)},
                                 {minor2(0, 1, 1, 2), -minor2(0, 1, 0, 2), minor2(0, 1, 0, 1)}};
  if (determinant == 0 || !std::isfinite(1 / determinant)) {
    return std::nullopt;
  }
  Transform inverted;
  for (int r = 0; r < 3; ++r) {
    double offset = 0;
    for (int c = 0; c < 3; ++c) {
      const double entry = cofactor[c][r] / determinant;
      inverted.m[r][c] = Float(entry);
      offset -= entry * m[c][3];
    }
    inverted.m[r][3] = Float(offset);
    for (Float entry : inverted.m[r]) {
      if (!std::isfinite(entry)) {
        return std::nullopt;
      }
    }
  }
  return inverted;
}

}  // namespace spectrace
