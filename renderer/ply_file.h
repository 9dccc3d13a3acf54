// SPDX-License-Identifier: Apache-2.0
// Meshes in PLY files (Turk 1994), as text or binary of either byte order.
#pragma once

#include <filesystem>

#include "renderer/geometry.h"

namespace spectrace {

/// Does it begin as PLY files do?
[[nodiscard]] bool is_ply(const std::filesystem::path& file);

/// Its vertices (x, y, z; nx, ny, nz; s, t or u, v or texture_u, texture_v or texture_s, texture_t) and
/// faces, polygons cut into fans from their first corner; what else it holds is passed over. Memory stays in
/// proportion to the file, whatever its header promises. Throws InputError naming line or byte. Not yet
/// cleaned.
[[nodiscard]] TriangleMesh read_ply(const std::filesystem::path& file);

}  // namespace spectrace
