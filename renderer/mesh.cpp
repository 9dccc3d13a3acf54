// SPDX-License-Identifier: Apache-2.0
#include "renderer/mesh.h"

#include <fmt/core.h>
#include <tiny_obj_loader.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <sstream>
#include <unordered_map>
#include <unordered_set>

#include "core/base/error.h"
#include "renderer/ply_file.h"

namespace spectrace {

namespace {

/// FNV-1a over whole words: collisions only cost time, equality decides.
struct WordsHash {
  template <typename Words>
  std::size_t operator()(const Words& words) const {
    std::uint64_t h = 0xcbf29ce484222325U;
    for (auto word : words) {
      h = (h ^ static_cast<std::uint64_t>(word)) * 0x100000001b3U;
      h ^= h >> 29U;
    }
    return h;
  }
};

using VertexKey = std::array<int, 3>;  // position, texture coordinate, normal; -1: none

Vec3 triple(const std::vector<tinyobj::real_t>& values, int index) {
  const std::size_t i = std::size_t(index) * 3;
  return {Float(values[i]), Float(values[i + 1]), Float(values[i + 2])};
}

/// Gives every combination of indices a vertex of its own.
class ObjWelder {
 public:
  ObjWelder(const tinyobj::attrib_t& attributes, std::string file)
      : attributes_(attributes), file_(std::move(file)) {
    has_normals_ = !attributes.normals.empty();
    has_uvs_ = !attributes.texcoords.empty();
  }

  std::uint32_t vertex(const tinyobj::index_t& index) {
    const auto outside = [](int i, std::size_t numbers, std::size_t per) { return i >= int(numbers / per); };
    if (index.vertex_index < 0 || outside(index.vertex_index, attributes_.vertices.size(), 3) ||
        outside(index.normal_index, attributes_.normals.size(), 3) ||
        outside(index.texcoord_index, attributes_.texcoords.size(), 2)) {
      throw InputError(
          file_, "",
          fmt::format("a face names vertex {}, which the file does not have", index.vertex_index + 1));
    }
    const VertexKey key{index.vertex_index, index.texcoord_index, index.normal_index};
    const auto [it, is_new] = known_.try_emplace(key, std::uint32_t(mesh.positions.size()));
    if (is_new) {
      mesh.positions.push_back(triple(attributes_.vertices, key[0]));
      if (has_uvs_) {
        const std::size_t i = std::size_t(std::max(key[1], 0)) * 2;
        mesh.uvs.push_back(
            key[1] < 0 ? Vec2{} : Vec2{Float(attributes_.texcoords[i]), Float(attributes_.texcoords[i + 1])});
      }
      if (has_normals_) {
        mesh.normals.push_back(key[2] < 0 ? Vec3{} : triple(attributes_.normals, key[2]));
      }
    }
    return it->second;
  }

  TriangleMesh mesh;

 private:
  const tinyobj::attrib_t& attributes_;
  std::string file_;
  bool has_normals_ = false, has_uvs_ = false;
  std::unordered_map<VertexKey, std::uint32_t, WordsHash> known_;
};

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

/// Twice the area, in double: a product of small floats must not underflow to "no area".
double doubled_area(Vec3 a, Vec3 b, Vec3 c) {
  const double ux = double(b.x) - a.x, uy = double(b.y) - a.y, uz = double(b.z) - a.z;
  const double vx = double(c.x) - a.x, vy = double(c.y) - a.y, vz = double(c.z) - a.z;
  return std::hypot(uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx);
}

/// The three positions' bits, in an order that neither the starting vertex nor the winding changes.
std::array<std::uint64_t, 9> position_key(std::array<Vec3, 3> p) {
  std::array<std::array<std::uint64_t, 3>, 3> bits;
  for (int i = 0; i < 3; ++i) {
    // + 0.0: the two zeros are one place.
    bits[i] = {std::bit_cast<std::uint64_t>(double(p[i].x) + 0.0),
               std::bit_cast<std::uint64_t>(double(p[i].y) + 0.0),
               std::bit_cast<std::uint64_t>(double(p[i].z) + 0.0)};
  }
  std::sort(bits.begin(), bits.end());
  std::array<std::uint64_t, 9> key;
  for (int i = 0; i < 9; ++i) {
    key[i] = bits[i / 3][i % 3];
  }
  return key;
}

void place_normals(TriangleMesh& mesh, const Transform& to_world, Float side, MeshReport& report) {
  for (Vec3& n : mesh.normals) {
    n = to_world.normal(n) * side;
    const double length = std::hypot(double(n.x), double(n.y), double(n.z));
    if (length > 0 && std::isfinite(length)) {
      n = {Float(n.x / length), Float(n.y / length), Float(n.z / length)};
    } else {
      n = {};
      ++report.bad_normals;
    }
  }
}

}  // namespace

std::string MeshReport::text(std::size_t triangles) const {
  std::string what;
  const auto add = [&what](std::size_t count, const char* kind) {
    if (count > 0) {
      what += fmt::format("{}{} {}", what.empty() ? "" : ", ", count, kind);
    }
  };
  add(non_finite, "not finite");
  add(too_large, "too large");
  add(zero_area, "without area");
  add(duplicate, "duplicate");
  if (!what.empty()) {
    what = fmt::format("{} of {} triangles skipped ({})", skipped(), triangles, what);
  }
  if (bad_normals > 0) {
    what += fmt::format("{}{} normals zero or not finite, replaced by the triangle's own",
                        what.empty() ? "" : "; ", bad_normals);
  }
  return what;
}

TriangleMesh read_obj(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) {
    throw InputError(file.string(), "", "cannot be opened");
  }
  tinyobj::attrib_t attributes;
  std::vector<tinyobj::shape_t> shapes;
  std::vector<tinyobj::material_t> materials;
  std::string warning, error;
  constexpr bool kTriangulate = true, kVertexColors = false;
  // No material reader: materials are the scene's, and a mesh may not open further files.
  const bool ok = tinyobj::LoadObj(&attributes, &shapes, &materials, &warning, &error, &stream, nullptr,
                                   kTriangulate, kVertexColors);
  if (!ok || !error.empty()) {
    throw InputError(file.string(), "", error.empty() ? "is not an OBJ file" : first_line(error));
  }
  ObjWelder welder(attributes, file.string());
  for (const tinyobj::shape_t& shape : shapes) {
    const auto& indices = shape.mesh.indices;
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
      const std::uint32_t a = welder.vertex(indices[i]);
      const std::uint32_t b = welder.vertex(indices[i + 1]);
      const std::uint32_t c = welder.vertex(indices[i + 2]);
      welder.mesh.triangles.push_back({a, b, c});
    }
  }
  return std::move(welder.mesh);
}

TriangleMesh read_mesh(const std::filesystem::path& file) {
  return is_ply(file) ? read_ply(file) : read_obj(file);
}

TriangleMesh place_mesh(TriangleMesh mesh, const Transform& to_world, MeshReport& report) {
  const bool mirrored = is_mirroring(to_world);
  for (Vec3& p : mesh.positions) {
    p = to_world.point(p);
  }
  place_normals(mesh, to_world, mirrored ? Float(-1) : Float(1), report);

  std::unordered_set<std::array<std::uint64_t, 9>, WordsHash> seen;
  std::vector<std::array<std::uint32_t, 3>> kept;
  kept.reserve(mesh.triangles.size());
  for (auto triangle : mesh.triangles) {
    std::array<Vec3, 3> p;
    for (int i = 0; i < 3; ++i) {
      SPECTRACE_CHECK(triangle[i] < mesh.positions.size());
      p[i] = mesh.positions[triangle[i]];
    }
    if (!is_finite(p[0]) || !is_finite(p[1]) || !is_finite(p[2])) {
      ++report.non_finite;
    } else if (std::max({max_abs(p[0]), max_abs(p[1]), max_abs(p[2])}) > kLargestCoordinate) {
      ++report.too_large;
    } else if (!(doubled_area(p[0], p[1], p[2]) > 0)) {
      ++report.zero_area;
    } else if (!seen.insert(position_key(p)).second) {
      ++report.duplicate;
    } else {
      if (mirrored) {
        std::swap(triangle[1], triangle[2]);
      }
      kept.push_back(triangle);
    }
  }
  mesh.triangles = std::move(kept);
  // A vertex no triangle uses may still hold a NaN, which would spoil the bounds.
  for (Vec3& p : mesh.positions) {
    if (!is_finite(p) || max_abs(p) > kLargestCoordinate) {
      p = mesh.triangles.empty() ? Vec3{} : mesh.positions[mesh.triangles[0][0]];
    }
  }
  return mesh;
}

}  // namespace spectrace
