// SPDX-License-Identifier: Apache-2.0
// Ray queries. The one door to Embree, version 3.13 or 4; none of its types passes through.
#pragma once

#include <memory>
#include <optional>

#include "renderer/geometry.h"

namespace spectrace {

/// Where a ray met a primitive.
struct Intersection {
  Float t = 0;  ///< in units of the ray's direction
  Float u = 0,
        v = 0;  ///< triangles: weights of vertices 1 and 2; quads, disks: along edge_u and edge_v; else 0
  std::uint32_t shape = 0;  ///< index into Geometry::shapes
  std::uint32_t primitive = 0;
  std::uint32_t instance = kNone;
};

/// Immutable once built; queries from any thread.
class Accel {
 public:
  explicit Accel(const Geometry& geometry);  ///< copies what it needs
  Accel(Accel&&) noexcept;
  Accel& operator=(Accel&&) noexcept;
  ~Accel();

  /// The nearest hit with 0 < t < t_max. Rays towards shared edges and vertices do not slip through.
  [[nodiscard]] std::optional<Intersection> intersect(const Ray& ray) const;
  [[nodiscard]] bool occluded(const Ray& ray) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// While it lives, this thread flushes denormal numbers to zero, as Embree asks of its callers.
class FlushDenormals {
 public:
  FlushDenormals();
  ~FlushDenormals();
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;

 private:
  unsigned saved_;
};

}  // namespace spectrace
