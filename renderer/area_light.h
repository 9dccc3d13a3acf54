// SPDX-License-Identifier: Apache-2.0
// Emitting spheres, quads, disks and triangles: one point on them for a point to be lit, with its density.
#pragma once

#include <optional>
#include <variant>

#include "core/math/vec.h"
#include "renderer/geometry.h"
#include "renderer/light_bounds.h"

namespace spectrace {

struct TriangleLight {
  Vec3 p0, edge_1, edge_2;  ///< front: edge_1 x edge_2
};
using LightShape = std::variant<Sphere, Quad, TriangleLight, Disk>;

/// A point on a light as seen from another point.
struct LightPoint {
  Vec3 wi;        ///< unit, towards the light
  Vec3 position;  ///< a rounding bound in front of the light: where a shadow ray ends
  Float pdf = 0;  ///< per solid angle [1/sr], > 0
};

/// Spheres: uniform over the cone they fill (Shirley et al. 1996). All others: uniform over the area.
/// nullopt where `from` sees no front (behind, inside, edge-on). `u` in [0, 1]².
[[nodiscard]] std::optional<LightPoint> sample_light(const LightShape& light, Vec3 from, Vec2 u);

/// The density sample_light(light, from) has for a ray from `from` along unit `wi` that met the light's front
/// at `position` with unit normal `normal`. 0 where it never takes that way.
[[nodiscard]] Float light_pdf(const LightShape& light, Vec3 from, Vec3 wi, Vec3 position, Vec3 normal);

[[nodiscard]] double light_area(const LightShape& light);

/// What LightTree knows of it; `radiance` [W·m⁻²·sr⁻¹·nm⁻¹].
[[nodiscard]] LightBounds light_bounds(const LightShape& light, double radiance);

}  // namespace spectrace
