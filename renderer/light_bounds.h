// SPDX-License-Identifier: Apache-2.0
// What is known of one light, or of many together, from afar: where they are, how brightly and whither they
// shine.
#pragma once

#include <array>

#include "core/math/vec.h"
#include "renderer/geometry.h"

namespace spectrace {

/// Emitters within a box and a sphere about its centre. Intensities are what is sent per solid angle,
/// averaged over wavelengths [W·sr⁻¹·nm⁻¹].
struct LightBounds {
  Box box;
  double radius = 0;  ///< of the sphere
  double around = 0;  ///< of what shines alike everywhere: points, spheres
  double facing = 0;  ///< of what shines by the cosine from its normal: flat lights, on the normal
  std::array<double, 3> directed{};  ///< the same as vectors along the normals, summed

  [[nodiscard]] Vec3 center() const { return box.center(); }
  [[nodiscard]] double intensity() const { return around + facing; }
  /// Length of the mean of all `facing` normals squared: 1 where they agree, 0 where they cancel out, or
  /// where there are none.
  [[nodiscard]] double agreement() const;
};

/// Of both together; either may be without a box: nothing.
[[nodiscard]] LightBounds unite(const LightBounds& a, const LightBounds& b);

[[nodiscard]] LightBounds bounds_around(const Box& box, double radius, double intensity);
[[nodiscard]] LightBounds bounds_facing(const Box& box, Vec3 unit_normal, double intensity);

}  // namespace spectrace
