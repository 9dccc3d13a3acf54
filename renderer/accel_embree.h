// SPDX-License-Identifier: Apache-2.0
// Ray queries. The one door to Embree, version 3.13 or 4; none of its types passes through.
#pragma once

#include <array>
#include <cstdint>
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

/// Rays traced together: as many as a register of 256 bits holds. Those that are left out may hold anything.
inline constexpr int kPacket = 8;
using RayPacket = std::array<Ray, kPacket>;
using HitPacket = std::array<std::optional<Intersection>, kPacket>;
using PacketMask = std::uint32_t;  ///< bit i: ray i takes part

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
  /// The same for each of the `active` rays; no other entry of `hits` is touched. `coherent`: they start
  /// together and keep together, as the rays of one pixel: several times as fast where true, slower where
  /// not.
  void intersect(const RayPacket& rays, PacketMask active, bool coherent, HitPacket& hits) const;
  [[nodiscard]] PacketMask occluded(const RayPacket& rays, PacketMask active, bool coherent) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace spectrace
