// SPDX-License-Identifier: Apache-2.0
// `spectrace inspect` of scenes and single materials, as their file describes them: no mesh, image or
// measurement is opened.
#include <fmt/format.h>

#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "cli/inspect_report.h"
#include "core/base/file.h"
#include "core/base/json.h"
#include "core/base/overloaded.h"
#include "materials/material.h"
#include "renderer/scene_desc.h"

namespace spectrace::cli {

namespace {

std::string text_of(Vec3 v) { return fmt::format("{} {} {}", v.x, v.y, v.z); }

std::string text_of(const Ggx& ggx) {
  return ggx.alpha_x == ggx.alpha_y ? fmt::format("alpha {}", ggx.alpha_x)
                                    : fmt::format("alpha {} x {}", ggx.alpha_x, ggx.alpha_y);
}

std::string text_of(const SeparatedDesc& s) {
  const std::string model = s.analytic    ? "analytic"
                            : s.model     ? name_of(*s.model)
                            : s.tolerance ? "auto"
                                          : "richest";
  return fmt::format("{}, model {}", s.file.string(), model);
}

/// Of a material: what kind, and what tells it from others of the kind.
using TypeAndDetail = std::pair<std::string, std::string>;
TypeAndDetail type_and_detail(const MaterialDesc& material);

/// "lambert, rough conductor".
std::string text_of(const std::vector<MaterialDesc>& parts) {
  std::string text;
  for (const MaterialDesc& part : parts) {
    text += (text.empty() ? "" : ", ") + type_and_detail(part).first;
  }
  return text;
}

TypeAndDetail type_and_detail(const MaterialDesc& material) {
  return std::visit(
      Overloaded{[](const Lambert&) -> TypeAndDetail {
                   return {"lambert", ""};
                 },
                 [](const SmoothConductor&) -> TypeAndDetail {
                   return {"smooth conductor", ""};
                 },
                 [](const RoughConductor& c) -> TypeAndDetail {
                   return {"rough conductor", text_of(c.ggx)};
                 },
                 [](const Dielectric&) -> TypeAndDetail {
                   return {"dielectric", ""};
                 },
                 [](const RoughDielectric& d) -> TypeAndDetail {
                   return {"rough dielectric", text_of(d.ggx())};
                 },
                 [](const Glossy& g) -> TypeAndDetail {
                   return {"glossy", fmt::format("{}, specular_scale {}, diffuse_scale {}", text_of(g.ggx),
                                                 g.specular_scale, g.diffuse_scale)};
                 },
                 [](const PlasticDesc& p) -> TypeAndDetail {
                   return {"plastic", p.alpha == 0 ? "smooth" : fmt::format("alpha {}", p.alpha)};
                 },
                 [](const Diffractive& d) -> TypeAndDetail {
                   return {"diffractive",
                           fmt::format("{}, micro-roughness {} nm rms over {} nm, specular_scale {}, "
                                       "diffuse_scale {}",
                                       text_of(d.ggx), d.micro.rms_nm, d.micro.correlation_nm,
                                       d.specular_scale, d.diffuse_scale)};
                 },
                 [](const TwoSidedDesc& t) -> TypeAndDetail {
                   return {"two-sided", text_of(t.parts)};
                 },
                 [](const MixDesc& m) -> TypeAndDetail {
                   return {"mix", text_of(m.parts)};
                 },
                 [](const MaskedDesc& m) -> TypeAndDetail {
                   return {"mask", text_of(m.parts)};
                 },
                 [](const NormalMappedDesc& m) -> TypeAndDetail {
                   return {"normal map", text_of(m.parts)};
                 },
                 [](const MeasuredDesc& m) -> TypeAndDetail {
                   return {"measured", m.file.string()};
                 },
                 [](const SeparatedDesc& s) -> TypeAndDetail {
                   return {"separated", text_of(s)};
                 }},
      material.kind);
}

std::vector<InspectCell> describe(const LightDesc& light) {
  return std::visit(
      Overloaded{[](const PointLightDesc& p) -> std::vector<InspectCell> {
                   return {std::string("point"), "at " + text_of(p.position)};
                 },
                 [](const SpotLightDesc& s) -> std::vector<InspectCell> {
                   return {std::string("spot"),
                           fmt::format("at {} towards {}, full to {} degrees, dark from {}",
                                       text_of(s.position), text_of(s.direction), s.falloff_deg, s.cone_deg)};
                 },
                 [](const DirectionalLightDesc& d) -> std::vector<InspectCell> {
                   return {std::string("directional"), "towards " + text_of(d.direction)};
                 },
                 [](const EnvironmentDesc& e) -> std::vector<InspectCell> {
                   return {std::string("environment"),
                           e.file.empty() ? std::string("constant")
                                          : fmt::format("{}, scale {}", e.file.string(), e.scale)};
                 }},
      light);
}

struct ShapeCounts {
  std::size_t spheres = 0, quads = 0, disks = 0, meshes = 0, instances = 0, emitters = 0;
};

void count_shapes(const std::vector<ShapeDesc>& shapes, ShapeCounts& counts) {
  for (const ShapeDesc& shape : shapes) {
    std::visit(
        Overloaded{[&](const SphereDesc&) { ++counts.spheres; }, [&](const QuadDesc&) { ++counts.quads; },
                   [&](const DiskDesc&) { ++counts.disks; }, [&](const MeshDesc&) { ++counts.meshes; },
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
  if (scene.camera.projection == Projection::kOrthographic) {
    camera.add("view_size", double(scene.camera.view_size));
  } else {
    camera.add("fov_deg", double(scene.camera.fov_deg));
  }
  if (scene.camera.lens_radius > 0) camera.add("lens_radius", double(scene.camera.lens_radius));

  ShapeCounts counts;
  count_shapes(scene.shapes, counts);
  for (const GroupDesc& group : scene.groups) count_shapes(group.shapes, counts);
  shapes.title = "shapes";
  shapes.add("spheres", counts.spheres);
  shapes.add("quads", counts.quads);
  shapes.add("disks", counts.disks);
  shapes.add("meshes", counts.meshes);
  shapes.add("instances", counts.instances);
  shapes.add("groups", scene.groups.size());
  shapes.add("emitters", counts.emitters);

  materials.title = "materials";
  materials.columns = {"name", "type", "detail"};
  for (const MaterialDesc& material : scene.materials) {
    const auto [type, detail] = type_and_detail(material);
    materials.rows.push_back({material.name, type, detail});
  }

  lights.title = "lights";
  lights.columns = {"type", "detail"};
  for (const LightDesc& light : scene.lights) lights.rows.push_back(describe(light));
  return {summary, camera, shapes, materials, lights};
}

bool is_material(const std::filesystem::path& file) {
  JsonDocument document = JsonDocument::load(file);
  const JsonValue root = document.root();
  return root.is_object() && root.get("type").exists() && !root.get("shapes").exists() &&
         !root.get("camera").exists();
}

InspectReport inspect_material(const std::filesystem::path& file) {
  const MaterialDesc material = load_material(file);
  const auto [type, detail] = type_and_detail(material);
  InspectSection section;
  section.title = "material";
  section.add("file", file.string());
  section.add("sha256", sha256_hex(read_file(file)));
  section.add("name", material.name);
  section.add("type", type);
  section.add("detail", detail);
  return {section};
}

}  // namespace spectrace::cli
