// SPDX-License-Identifier: Apache-2.0
// `spectrace inspect` of scenes, as their file describes them: no mesh, image or measurement is opened.
#include <fmt/format.h>

#include <string_view>
#include <type_traits>

#include "cli/inspect_report.h"
#include "renderer/scene_desc.h"

namespace spectrace::cli {

namespace {

template <typename... Visitors>
struct Overloaded : Visitors... {
  using Visitors::operator()...;
};
template <typename... Visitors>
Overloaded(Visitors...) -> Overloaded<Visitors...>;

std::string text_of(Vec3 v) { return fmt::format("{} {} {}", v.x, v.y, v.z); }

std::vector<InspectCell> describe(const MaterialDesc& material) {
  const auto [type, detail] = std::visit(
      Overloaded{
          [](const Lambert&) { return std::pair<std::string, std::string>("lambert", ""); },
          [](const SmoothConductor&) { return std::pair<std::string, std::string>("smooth conductor", ""); },
          [](const RoughConductor&) { return std::pair<std::string, std::string>("rough conductor", ""); },
          [](const Dielectric&) { return std::pair<std::string, std::string>("dielectric", ""); },
          [](const Glossy&) { return std::pair<std::string, std::string>("glossy", ""); },
          [](const Diffractive&) { return std::pair<std::string, std::string>("diffractive", ""); },
          [](const MeasuredDesc& m) {
            return std::pair<std::string, std::string>("measured", m.file.string());
          },
          [](const SeparatedDesc& s) {
            return std::pair<std::string, std::string>("separated",
                                                       fmt::format("{}, model {}", s.file.string(),
                                                                   s.analytic ? "analytic"
                                                                   : s.model  ? name_of(*s.model)
                                                                              : "richest"));
          }},
      material.kind);
  return {material.name, type, detail};
}

std::vector<InspectCell> describe(const LightDesc& light) {
  return std::visit(Overloaded{[](const PointLightDesc& p) -> std::vector<InspectCell> {
                                 return {std::string("point"), "at " + text_of(p.position)};
                               },
                               [](const DirectionalLightDesc& d) -> std::vector<InspectCell> {
                                 return {std::string("directional"), "towards " + text_of(d.direction)};
                               },
                               [](const EnvironmentDesc& e) -> std::vector<InspectCell> {
                                 return {std::string("environment"),
                                         e.file.empty()
                                             ? std::string("constant")
                                             : fmt::format("{}, scale {}", e.file.string(), e.scale)};
                               }},
                    light);
}

struct ShapeCounts {
  std::size_t spheres = 0, quads = 0, meshes = 0, instances = 0, emitters = 0;
};

void count_shapes(const std::vector<ShapeDesc>& shapes, ShapeCounts& counts) {
  for (const ShapeDesc& shape : shapes) {
    std::visit(Overloaded{[&](const SphereDesc&) { ++counts.spheres; },
                          [&](const QuadDesc&) { ++counts.quads; }, [&](const MeshDesc&) { ++counts.meshes; },
                          [&](const InstanceDesc&) { ++counts.instances; }},
               shape.kind);
    counts.emitters += shape.emission ? 1 : 0;
  }
}

}  // namespace

InspectReport inspect_scene(const std::filesystem::path& file) {
  const SceneDesc scene = load_scene(file);
  InspectSection summary, camera, shapes, materials, lights;
  summary.title = "scene";
  summary.add("file", file.string());
  summary.add("sha256", scene.sha256);
  summary.add("width", scene.film.width);
  summary.add("height", scene.film.height);
  summary.add("spp", scene.spp);
  summary.add("seed", std::to_string(scene.seed));
  summary.add("first_nm", double(scene.range.min_nm));
  summary.add("last_nm", double(scene.range.max_nm));
  summary.add("wavelength_sampling", scene.visible_sampling ? "by the observer's sensitivity" : "uniform");
  summary.add("max_depth", scene.integrator.max_depth);
  summary.add("roulette_depth", scene.integrator.roulette_depth);
  summary.add("next_event", scene.integrator.next_event);

  camera.title = "camera";
  camera.add("origin", text_of(scene.camera.origin));
  camera.add("target", text_of(scene.camera.target));
  camera.add("up", text_of(scene.camera.up));
  camera.add("fov_deg", double(scene.camera.fov_deg));

  ShapeCounts counts;
  count_shapes(scene.shapes, counts);
  for (const GroupDesc& group : scene.groups) count_shapes(group.shapes, counts);
  shapes.title = "shapes";
  shapes.add("spheres", counts.spheres);
  shapes.add("quads", counts.quads);
  shapes.add("meshes", counts.meshes);
  shapes.add("instances", counts.instances);
  shapes.add("groups", scene.groups.size());
  shapes.add("emitters", counts.emitters);

  materials.title = "materials";
  materials.columns = {"name", "type", "detail"};
  for (const MaterialDesc& material : scene.materials) materials.rows.push_back(describe(material));

  lights.title = "lights";
  lights.columns = {"type", "detail"};
  for (const LightDesc& light : scene.lights) lights.rows.push_back(describe(light));
  return {summary, camera, shapes, materials, lights};
}

}  // namespace spectrace::cli
