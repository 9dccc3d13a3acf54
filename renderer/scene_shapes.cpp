// SPDX-License-Identifier: Apache-2.0
#include "renderer/scene_shapes.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/error.h"
#include "core/base/nearest.h"
#include "core/base/overloaded.h"
#include "core/math/math.h"
#include "renderer/mesh.h"
#include "renderer/obj_file.h"
#include "renderer/ply_file.h"

namespace spectrace {

namespace {

/// A sphere stays a sphere only under moves, turns, reflections and one scale for all axes.
std::optional<Float> uniform_scale(const Transform& t) {
  // 1e-4: matrices written with five digits count as rotations.
  constexpr Float kTolerance = Float(1e-4);
  const Vec3 x = t.vector({1, 0, 0}), y = t.vector({0, 1, 0}), z = t.vector({0, 0, 1});
  const Float scale = length(x);
  const bool equal =
      std::abs(length(y) - scale) <= kTolerance * scale && std::abs(length(z) - scale) <= kTolerance * scale;
  const Float bound = kTolerance * scale * scale;
  const bool square =
      std::abs(dot(x, y)) <= bound && std::abs(dot(y, z)) <= bound && std::abs(dot(z, x)) <= bound;
  return equal && square ? std::optional<Float>(scale) : std::nullopt;
}

bool in_reach(Vec3 p) { return is_finite(p) && max_abs(p) <= kLargestCoordinate; }

}  // namespace

void ShapeBuilder::fail(const ShapeDesc& shape, std::string problem) const {
  throw InputError(description_.file_name, shape.where, std::move(problem));
}

std::uint32_t ShapeBuilder::material_index(const ShapeDesc& shape, const std::string& name) const {
  const auto& materials = description_.materials;
  const auto it =
      std::find_if(materials.begin(), materials.end(), [&](const MaterialDesc& m) { return m.name == name; });
  if (it == materials.end()) {
    fail(shape, fmt::format("no material is named \"{}\"", name));
  }
  return std::uint32_t(it - materials.begin());
}

std::optional<Shape> ShapeBuilder::make(const ShapeDesc& shape, const SphereDesc& sphere) {
  const std::optional<Float> scale = uniform_scale(shape.to_world);
  if (!scale) {
    fail(shape,
         "a sphere may be moved, turned and scaled alike on all axes only; put it into a group and "
         "instance that for an ellipsoid");
  }
  const Sphere placed{shape.to_world.point(sphere.center), sphere.radius * *scale};
  if (!in_reach(placed.center) || !(placed.radius > 0) || !(placed.radius <= kLargestCoordinate)) {
    progress_.note(
        fmt::format("{}: sphere of radius {} skipped: nothing to hit", shape.where, placed.radius));
    return std::nullopt;
  }
  return Shape{.geometry = placed};
}

std::optional<Shape> ShapeBuilder::make(const ShapeDesc& shape, const QuadDesc& quad) {
  const Transform& t = shape.to_world;
  const Quad placed{t.point(quad.corner), t.vector(quad.edge_u), t.vector(quad.edge_v), is_mirroring(t)};
  const Vec3 far = placed.corner + placed.edge_u + placed.edge_v;
  const Float u = max_abs(placed.edge_u), v = max_abs(placed.edge_v);
  if (!in_reach(placed.corner) || !in_reach(far) || !in_reach(placed.edge_u) || !in_reach(placed.edge_v) ||
      !(u > 0) || !(v > 0) || cross(placed.edge_u / u, placed.edge_v / v) == Vec3{}) {
    progress_.note(fmt::format("{}: quad without area, or out of reach, skipped", shape.where));
    return std::nullopt;
  }
  return Shape{.geometry = placed};
}

std::optional<Shape> ShapeBuilder::make(const ShapeDesc& shape, const DiskDesc& disk) {
  if (!(length_squared(disk.normal) > 0)) {
    fail(shape, "the normal of a disk must not be zero");
  }
  const Transform& t = shape.to_world;
  const Frame frame = Frame::from_normal(normalize(disk.normal));
  const Disk placed{t.point(disk.center), t.vector(frame.s * disk.radius), t.vector(frame.t * disk.radius),
                    is_mirroring(t)};
  const Float u = max_abs(placed.edge_u), v = max_abs(placed.edge_v);
  if (!in_reach(placed.center) || !in_reach(placed.edge_u) || !in_reach(placed.edge_v) ||
      !(largest_coordinate(placed) <= kLargestCoordinate) || !(u > 0) || !(v > 0) ||
      cross(placed.edge_u / u, placed.edge_v / v) == Vec3{}) {
    progress_.note(fmt::format("{}: disk without area, or out of reach, skipped", shape.where));
    return std::nullopt;
  }
  return Shape{.geometry = placed};
}

std::optional<Shape> ShapeBuilder::make(const ShapeDesc& shape, const MeshDesc& mesh) {
  const std::string name = mesh.file.empty() ? shape.where : mesh.file.string();
  TriangleMesh loaded;
  if (mesh.file.empty()) {
    for (const auto& triangle : mesh.triangles) {
      for (std::uint32_t index : triangle) {
        if (index >= mesh.positions.size()) {
          fail(shape, fmt::format("a triangle names vertex {} of {}", index, mesh.positions.size()));
        }
      }
    }
    loaded.positions = mesh.positions;
    loaded.triangles = mesh.triangles;
  } else {
    loaded = read_mesh(mesh.file);
  }
  if (!mesh.smooth_normals) {
    loaded.normals.clear();
  }
  return make(shape, std::move(loaded), name);
}

std::optional<Shape> ShapeBuilder::make(const ShapeDesc& shape, TriangleMesh loaded,
                                        const std::string& name) {
  const std::size_t triangles = loaded.triangles.size();
  MeshReport report;
  loaded = place_mesh(std::move(loaded), shape.to_world, report);
  if (const std::string text = report.text(triangles); !text.empty()) {
    progress_.note(fmt::format("mesh {}: {}", name, text));
  }
  if (loaded.triangles.empty()) {
    progress_.note(fmt::format("mesh {}: empty, nothing to hit", name));
    return std::nullopt;
  }
  return Shape{.geometry = std::move(loaded)};
}

void ShapeBuilder::add_lights(Shape& shape, const Spectrum& emission) {
  shape.first_light = std::uint32_t(area_lights.size());
  const auto index = std::uint32_t(emissions.size());
  emissions.push_back(emission);
  std::visit(Overloaded{[&](const TriangleMesh& mesh) {
                          for (const auto& [a, b, c] : mesh.triangles) {
                            const Vec3 p0 = mesh.positions[a];
                            area_lights.push_back(
                                {TriangleLight{p0, mesh.positions[b] - p0, mesh.positions[c] - p0}, index});
                          }
                        },
                        [&](const auto& whole) {
                          area_lights.push_back({LightShape(whole), index});
                        }},
             shape.geometry);
  light_groups.push_back(std::uint32_t(area_lights.size()) - shape.first_light);
}

void ShapeBuilder::place(Shape made, std::uint32_t material, const std::optional<Spectrum>& emission) {
  made.material = material;
  made.object = object_;
  if (emission && emission->max_over(description_.range) > 0) {
    add_lights(made, *emission);
  }
  geometry.shapes.push_back(std::move(made));
}

void ShapeBuilder::add_mesh_by_materials(const ShapeDesc& shape, const MeshDesc& mesh) {
  if (is_ply(mesh.file)) {
    fail(shape, "\"materials\" of a PLY file: it has none; give a \"material\"");
  }
  ObjGroups parts = read_obj_groups(mesh.file);
  std::vector<std::string> used;
  for (const ObjGroups::Group& part : parts.groups) used.push_back(part.material);
  for (const auto& [name, scene_name] : *mesh.materials) {
    if (std::find(used.begin(), used.end(), name) == used.end()) {
      fail(shape, fmt::format("\"materials\" has \"{}\", which no face of {} uses{}", name,
                              mesh.file.string(), suggestion(name, used)));
    }
  }
  for (ObjGroups::Group& part : parts.groups) {
    MaterialLibraries::Found found;
    if (const auto it = mesh.materials->find(part.material); it != mesh.materials->end()) {
      found.index = material_index(shape, it->second);
    } else if (!part.material.empty()) {
      found = libraries.find(part.material, parts.libraries, mesh.file);
    } else if (!shape.material.empty()) {
      found.index = material_index(shape, shape.material);
    } else {
      fail(shape, fmt::format("{} has faces before its first usemtl: give a \"material\" for them",
                              mesh.file.string()));
    }
    if (found.emission && in_group_) {
      progress_.note(fmt::format("{}: Ke of \"{}\" left out: shapes inside groups cannot emit", shape.where,
                                 part.material));
      found.emission.reset();
    }
    if (!mesh.smooth_normals) part.mesh.normals.clear();
    const std::string name = fmt::format("{}, \"{}\"", mesh.file.string(), part.material);
    if (std::optional<Shape> made = make(shape, std::move(part.mesh), name)) {
      place(std::move(*made), found.index, found.emission);
    }
  }
}

void ShapeBuilder::add_shape(const ShapeDesc& shape) {
  if (const auto* mesh = std::get_if<MeshDesc>(&shape.kind); mesh != nullptr && mesh->materials) {
    add_mesh_by_materials(shape, *mesh);
    return;
  }
  const std::uint32_t material = material_index(shape, shape.material);
  std::optional<Shape> made =
      std::visit(Overloaded{[](const InstanceDesc&) { return std::optional<Shape>(); },  // add_instance()
                            [&](const auto& kind) { return make(shape, kind); }},
                 shape.kind);
  if (made) {
    place(std::move(*made), material, shape.emission);
  }
}

ShapeRange ShapeBuilder::add_shapes(const std::vector<ShapeDesc>& shapes) {
  ShapeRange range{std::uint32_t(geometry.shapes.size()), 0};
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    object_ = in_group_ ? 0 : std::uint32_t(i);
    if (!std::holds_alternative<InstanceDesc>(shapes[i].kind)) add_shape(shapes[i]);
  }
  range.end = std::uint32_t(geometry.shapes.size());
  return range;
}

void ShapeBuilder::add_instance(const ShapeDesc& shape, const std::string& group) {
  const auto& groups = description_.groups;
  const auto it =
      std::find_if(groups.begin(), groups.end(), [&](const GroupDesc& g) { return g.name == group; });
  if (it == groups.end()) {
    fail(shape, fmt::format("no group is named \"{}\"", group));
  }
  const std::optional<Transform> to_local = inverse(shape.to_world);
  if (!to_local) {
    fail(shape, "an instance's transform must be invertible");
  }
  const auto index = std::uint32_t(it - groups.begin());
  const ShapeRange range = geometry.groups[index];
  if (range.begin == range.end) {
    progress_.note(fmt::format("{}: group \"{}\" is empty, nothing to hit", shape.where, group));
    return;
  }
  geometry.instances.push_back({index, shape.to_world, *to_local, is_mirroring(shape.to_world), object_});
}

void ShapeBuilder::build() {
  in_group_ = true;
  for (const GroupDesc& group : description_.groups) {
    for (const ShapeDesc& shape : group.shapes) {
      if (std::holds_alternative<InstanceDesc>(shape.kind) || shape.emission) {
        fail(shape, "groups hold neither instances nor emitting shapes");
      }
    }
    geometry.groups.push_back(add_shapes(group.shapes));
  }
  in_group_ = false;
  geometry.top = add_shapes(description_.shapes);
  for (std::size_t i = 0; i < description_.shapes.size(); ++i) {
    const ShapeDesc& shape = description_.shapes[i];
    object_ = std::uint32_t(i);
    if (const auto* instance = std::get_if<InstanceDesc>(&shape.kind)) add_instance(shape, instance->group);
  }
}

}  // namespace spectrace
