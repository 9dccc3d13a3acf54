// SPDX-License-Identifier: Apache-2.0
#include "renderer/mesh.h"

#include <fmt/core.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <unordered_set>

#include "core/base/error.h"
#include "renderer/obj_file.h"
#include "renderer/ply_file.h"
#include "renderer/words_hash.h"

namespace spectrace {

namespace {

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
