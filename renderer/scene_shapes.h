// SPDX-License-Identifier: Apache-2.0
// From shape descriptions to shapes in place: a part of build_scene().
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "renderer/geometry.h"
#include "renderer/lights.h"
#include "renderer/material_libraries.h"
#include "renderer/scene_desc.h"

namespace spectrace {

/// Shapes of a scene and the area lights among them.
class ShapeBuilder {
 public:
  ShapeBuilder(const SceneDesc& description, Progress& progress)
      : libraries(description.materials.size(), progress), description_(description), progress_(progress) {}

  /// Adds all groups, shapes and instances. Throws InputError.
  void build();

  Geometry geometry;
  std::vector<Lights::AreaLight> area_lights;
  std::vector<std::uint32_t> light_groups;  ///< sizes: the lights of one shape are one emitter
  std::vector<Spectrum> emissions;
  MaterialLibraries libraries;  ///< materials that meshes bring along: behind the scene's own

 private:
  ShapeRange add_shapes(const std::vector<ShapeDesc>& shapes);
  void add_shape(const ShapeDesc& shape);
  void add_mesh_by_materials(const ShapeDesc& shape, const MeshDesc& mesh);
  void place(Shape made, std::uint32_t material, const std::optional<Spectrum>& emission);
  void add_lights(Shape& shape, const Spectrum& emission);
  void add_instance(const ShapeDesc& shape, const std::string& group);
  [[nodiscard]] std::uint32_t material_index(const ShapeDesc& shape, const std::string& name) const;
  [[noreturn]] void fail(const ShapeDesc& shape, std::string problem) const;

  std::optional<Shape> make(const ShapeDesc& shape, const SphereDesc& sphere);
  std::optional<Shape> make(const ShapeDesc& shape, const QuadDesc& quad);
  std::optional<Shape> make(const ShapeDesc& shape, const DiskDesc& disk);
  std::optional<Shape> make(const ShapeDesc& shape, const MeshDesc& mesh);
  std::optional<Shape> make(const ShapeDesc& shape, TriangleMesh mesh, const std::string& name);

  const SceneDesc& description_;
  Progress& progress_;
  bool in_group_ = false;
  std::uint32_t object_ = 0;  // which of the scene file's shapes is at hand
};

}  // namespace spectrace
