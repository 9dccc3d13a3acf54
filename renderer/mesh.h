// SPDX-License-Identifier: Apache-2.0
// Triangle meshes: read from OBJ or PLY, moved into place, cleaned.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "core/math/vec.h"
#include "renderer/geometry.h"

namespace spectrace {

/// Coordinates beyond this are Embree's to drop (it states 1.844e18): dropped here first, and counted.
inline constexpr Float kLargestCoordinate = Float(1e18);

/// What cleaning left out or changed.
struct MeshReport {
  std::size_t non_finite = 0;   ///< triangles with NaN or infinite vertices
  std::size_t too_large = 0;    ///< triangles reaching beyond kLargestCoordinate
  std::size_t zero_area = 0;    ///< triangles without area
  std::size_t duplicate = 0;    ///< triangles with the very vertices of an earlier one, wound either way
  std::size_t bad_normals = 0;  ///< normals that are zero or not finite: the triangle's own is used instead

  [[nodiscard]] std::size_t skipped() const { return non_finite + too_large + zero_area + duplicate; }
  /// "3 triangles without area and 1 duplicate skipped of 968; ...", empty where nothing happened.
  [[nodiscard]] std::string text(std::size_t triangles) const;
};

/// A PLY file if it begins as one, else an OBJ file.
[[nodiscard]] TriangleMesh read_mesh(const std::filesystem::path& file);

/// The mesh under a transform, without triangles that cannot be hit (hard case H14). Reflections keep fronts
/// in front: winding is turned. Triangle indices must lie within `positions` (checked).
[[nodiscard]] TriangleMesh place_mesh(TriangleMesh mesh, const Transform& to_world, MeshReport& report);

}  // namespace spectrace
