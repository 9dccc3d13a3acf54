// SPDX-License-Identifier: Apache-2.0
// Two- and three-vectors, orthonormal frames and affine transforms: no more than a path tracer needs.
#pragma once

#include <array>
#include <cmath>

#include "core/base/float.h"

namespace spectrace {

struct Vec2 {
  Float x = 0, y = 0;
};

struct Vec3 {
  Float x = 0, y = 0, z = 0;

  friend constexpr Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend constexpr Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend constexpr Vec3 operator-(Vec3 a) { return {-a.x, -a.y, -a.z}; }
  friend constexpr Vec3 operator*(Vec3 a, Float s) { return {a.x * s, a.y * s, a.z * s}; }
  friend constexpr Vec3 operator*(Float s, Vec3 a) { return a * s; }
  friend constexpr Vec3 operator/(Vec3 a, Float s) { return a * (Float(1) / s); }
  friend constexpr bool operator==(Vec3, Vec3) = default;
};

constexpr Float dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
constexpr Vec3 cross(Vec3 a, Vec3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
constexpr Float length_squared(Vec3 a) { return dot(a, a); }
inline Float length(Vec3 a) { return std::sqrt(dot(a, a)); }
/// `a` must not be zero.
inline Vec3 normalize(Vec3 a) { return a / length(a); }
inline bool is_finite(Vec3 a) { return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z); }

/// Right-handed orthonormal frame around a unit normal; local z is the normal.
struct Frame {
  Vec3 s{1, 0, 0}, t{0, 1, 0}, n{0, 0, 1};

  /// Branchless and continuous save at one sign change: Duff et al. 2017, "Building an Orthonormal Basis,
  /// Revisited".
  static Frame from_normal(Vec3 n) {
    const Float sign = std::copysign(Float(1), n.z);
    const Float a = -1 / (sign + n.z);
    const Float b = n.x * n.y * a;
    return {{1 + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}, n};
  }
  [[nodiscard]] Vec3 to_local(Vec3 v) const { return {dot(v, s), dot(v, t), dot(v, n)}; }
  [[nodiscard]] Vec3 to_world(Vec3 v) const { return s * v.x + t * v.y + n * v.z; }
};

/// Affine map, rows of a 3x4 matrix: point p -> (row[i].xyz · p + row[i].w).
struct Transform {
  std::array<std::array<Float, 4>, 3> m{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};

  [[nodiscard]] Vec3 point(Vec3 p) const {
    return {m[0][0] * p.x + m[0][1] * p.y + m[0][2] * p.z + m[0][3],
            m[1][0] * p.x + m[1][1] * p.y + m[1][2] * p.z + m[1][3],
            m[2][0] * p.x + m[2][1] * p.y + m[2][2] * p.z + m[2][3]};
  }
  [[nodiscard]] Vec3 vector(Vec3 v) const {
    return {m[0][0] * v.x + m[0][1] * v.y + m[0][2] * v.z, m[1][0] * v.x + m[1][1] * v.y + m[1][2] * v.z,
            m[2][0] * v.x + m[2][1] * v.y + m[2][2] * v.z};
  }
  /// (this ∘ inner)(p) = this(inner(p)).
  [[nodiscard]] Transform compose(const Transform& inner) const {
    Transform r;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 4; ++j) {
        r.m[i][j] = m[i][0] * inner.m[0][j] + m[i][1] * inner.m[1][j] + m[i][2] * inner.m[2][j];
      }
      r.m[i][3] += m[i][3];
    }
    return r;
  }
  [[nodiscard]] Float determinant() const {
    return dot({m[0][0], m[0][1], m[0][2]}, cross({m[1][0], m[1][1], m[1][2]}, {m[2][0], m[2][1], m[2][2]}));
  }
  /// The cofactor matrix applied to a normal: the inverse transpose times the determinant; not normalised.
  [[nodiscard]] Vec3 normal(Vec3 n) const {
    const Vec3 a{m[0][0], m[0][1], m[0][2]}, b{m[1][0], m[1][1], m[1][2]}, c{m[2][0], m[2][1], m[2][2]};
    return {dot(cross(b, c), n), dot(cross(c, a), n), dot(cross(a, b), n)};
  }
};

}  // namespace spectrace
