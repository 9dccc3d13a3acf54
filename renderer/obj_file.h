// SPDX-License-Identifier: Apache-2.0
// Meshes in Wavefront OBJ files: the one door to tinyobjloader.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "renderer/geometry.h"

namespace spectrace {

/// All faces of an OBJ file, polygons cut into triangles. Throws InputError where it cannot be read or an
/// index names no vertex. Not yet cleaned.
[[nodiscard]] TriangleMesh read_obj(const std::filesystem::path& file);

/// The faces of an OBJ file by the material that "usemtl" names, in the order of their first use.
struct ObjGroups {
  struct Group {
    std::string material;  ///< empty: faces before the first usemtl
    TriangleMesh mesh;
  };
  std::vector<Group> groups;
  std::vector<std::filesystem::path> libraries;  ///< of its "mtllib"; they may be missing
};
/// As read_obj().
[[nodiscard]] ObjGroups read_obj_groups(const std::filesystem::path& file);

}  // namespace spectrace
