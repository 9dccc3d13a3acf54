// SPDX-License-Identifier: Apache-2.0
// Shapes, groups and transforms of a scene file.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/nearest.h"
#include "core/math/math.h"
#include "renderer/scene_parser.h"

namespace spectrace {
namespace {

// A map whose determinant is this much smaller than its rows' lengths allow flattens shapes to planes, as far
// as single precision can tell (its rounding is 6e-8).
constexpr double kSingular = 1e-6;

using Rows = std::array<std::array<double, 4>, 3>;

Transform to_transform(const Rows& rows) {
  Transform t;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 4; ++j) {
      t.m[i][j] = static_cast<Float>(rows[i][j]);
    }
  }
  return t;
}

bool is_singular(const Transform& t) {
  std::array<std::array<double, 3>, 3> unit{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double norm = std::hypot(static_cast<double>(t.m[i][0]), t.m[i][1], t.m[i][2]);
    if (!(norm > 0) || !std::isfinite(norm) || !std::isfinite(t.m[i][3])) {
      return true;
    }
    for (std::size_t j = 0; j < 3; ++j) {
      unit[i][j] = t.m[i][j] / norm;
    }
  }
  const double det = unit[0][0] * (unit[1][1] * unit[2][2] - unit[1][2] * unit[2][1]) -
                     unit[0][1] * (unit[1][0] * unit[2][2] - unit[1][2] * unit[2][0]) +
                     unit[0][2] * (unit[1][0] * unit[2][1] - unit[1][1] * unit[2][0]);
  return !(std::abs(det) > kSingular);
}

/// Rodrigues' formula, counter-clockwise seen against the axis.
Rows rotation(Vec3 axis, double angle_deg) {
  const double norm = std::hypot(static_cast<double>(axis.x), axis.y, axis.z);
  const double x = axis.x / norm, y = axis.y / norm, z = axis.z / norm;
  const double angle_rad = std::fmod(angle_deg, 360.0) * (kPi64 / 180);
  const double c = std::cos(angle_rad), s = std::sin(angle_rad), d = 1 - c;
  return {{{c + d * x * x, d * x * y - s * z, d * x * z + s * y, 0},
           {d * x * y + s * z, c + d * y * y, d * y * z - s * x, 0},
           {d * x * z - s * y, d * y * z + s * x, c + d * z * z, 0}}};
}

Transform parse_rotate(const JsonValue& json) {
  const Vec3 axis = parse_nonzero(json.require("axis"), {0, 0, 1});
  const double angle_deg = json.require("angle_deg").number(0);
  json.reject_unknown_keys();
  return to_transform(rotation(axis, angle_deg));
}

Transform parse_scale(const JsonValue& json) {
  Vec3 s{1, 1, 1};
  if (json.is_array()) {
    s = json.vec3(s);
  } else {
    const auto all = static_cast<Float>(json.number(1));
    s = {all, all, all};
  }
  return to_transform({{{s.x, 0, 0, 0}, {0, s.y, 0, 0}, {0, 0, s.z, 0}}});
}

Transform parse_matrix(const JsonValue& json) {
  const std::vector<double> m = json.numbers(12, 12);
  if (m.size() != 12) {
    return {};
  }
  Rows rows{};
  for (std::size_t i = 0; i < 12; ++i) {
    rows[i / 4][i % 4] = m[i];
  }
  return to_transform(rows);
}

Transform parse_step(const JsonValue& json) {
  if (!json.is_object()) {
    json.error("expected an object with one of translate, rotate, scale, matrix");
    return {};
  }
  const JsonValue translate = json.get("translate"), rotate = json.get("rotate"), scale = json.get("scale"),
                  matrix = json.get("matrix");
  json.reject_unknown_keys();
  if (translate.exists() + rotate.exists() + scale.exists() + matrix.exists() > 1) {
    json.error("more than one of translate, rotate, scale, matrix: give a list, its first is applied first");
    return {};
  }
  if (translate.exists()) {
    const Vec3 v = translate.vec3({});
    return to_transform({{{1, 0, 0, v.x}, {0, 1, 0, v.y}, {0, 0, 1, v.z}}});
  }
  if (rotate.exists()) {
    return parse_rotate(rotate);
  }
  return scale.exists() ? parse_scale(scale) : matrix.exists() ? parse_matrix(matrix) : Transform{};
}

SphereDesc parse_sphere(const JsonValue& json) {
  SphereDesc sphere;
  sphere.center = json.get("center").vec3(sphere.center);
  sphere.radius = static_cast<Float>(json.get("radius").number(sphere.radius, kPositiveFloat));
  return sphere;
}

QuadDesc parse_quad(const JsonValue& json) {
  QuadDesc quad;
  quad.corner = json.require("corner").vec3(quad.corner);
  quad.edge_u = parse_nonzero(json.require("edge_u"), quad.edge_u);
  const JsonValue edge_v = json.require("edge_v");
  quad.edge_v = parse_nonzero(edge_v, quad.edge_v);
  if (edge_v.exists() && length(cross(normalize(quad.edge_u), normalize(quad.edge_v))) < Float(kSingular)) {
    edge_v.error("is parallel to edge_u: the quad has no area");
  }
  return quad;
}

DiskDesc parse_disk(const JsonValue& json) {
  DiskDesc disk;
  disk.center = json.get("center").vec3(disk.center);
  disk.normal = parse_nonzero(json.get("normal"), disk.normal);
  disk.radius = static_cast<Float>(json.get("radius").number(disk.radius, kPositiveFloat));
  return disk;
}

void parse_triangles(const JsonValue& json, MeshDesc& mesh) {
  const auto count = static_cast<std::int64_t>(mesh.positions.size());
  for (const JsonValue& element : json.elements()) {
    const std::vector<JsonValue> corners = element.elements();
    if (corners.size() != 3) {
      if (element.is_array()) {
        element.error(fmt::format("expected three indices of positions, got {}", corners.size()));
      }
      continue;
    }
    if (count == 0) {
      element.error("a triangle without positions");
      continue;
    }
    std::array<std::uint32_t, 3> triangle{};
    for (std::size_t i = 0; i < 3; ++i) {
      triangle[i] = static_cast<std::uint32_t>(corners[i].integer(0, 0, count - 1));
    }
    mesh.triangles.push_back(triangle);
  }
}

/// The value as a name that must be in `known`.
std::string parse_reference(const JsonValue& json, const char* what, const std::vector<std::string>& known) {
  std::string name = json.string();
  if (json.is_string() && std::find(known.begin(), known.end(), name) == known.end()) {
    json.error(fmt::format("there is no {} \"{}\"{}", what, name, suggestion(name, known)));
  }
  return name;
}

/// {"usemtl name": "scene's name"}.
std::map<std::string, std::string> parse_mapping(const JsonValue& json,
                                                 const std::vector<std::string>& known) {
  std::map<std::string, std::string> mapping;
  for (const std::string& key : json.keys()) {
    mapping[key] = parse_reference(json.get(key), "material", known);
  }
  return mapping;
}

MeshDesc parse_mesh(const JsonValue& json, const SceneNames& names) {
  MeshDesc mesh;
  const JsonValue file = json.get("file"), positions = json.get("positions"),
                  triangles = json.get("triangles");
  if (file.exists()) {
    mesh.file = parse_existing_file(file);
    mesh.smooth_normals = json.get("smooth_normals").boolean(mesh.smooth_normals);
    if (const JsonValue materials = json.get("materials"); materials.exists()) {
      mesh.materials = parse_mapping(materials, names.materials);
      if (const JsonValue emission = json.get("emission"); emission.exists()) {
        emission.error("\"materials\" leaves it to the file's library (Ke) what emits");
      }
    }
    if (positions.exists() || triangles.exists()) {
      (positions.exists() ? positions : triangles)
          .error("a mesh is a \"file\" or \"positions\" and \"triangles\", not both");
    }
    return mesh;
  }
  if (!positions.exists() && !triangles.exists()) {
    json.error("a mesh needs a \"file\", or \"positions\" and \"triangles\"");
    return mesh;
  }
  for (const JsonValue& element : json.require("positions").elements()) {
    mesh.positions.push_back(element.vec3({}));
  }
  parse_triangles(json.require("triangles"), mesh);
  return mesh;
}

/// Of any length but zero, where there is one.
std::string parse_name(const JsonValue& json) {
  std::string name = json.string();
  if (json.is_string() && name.empty()) json.error("expected a name, got an empty string");
  return name;
}

}  // namespace

Transform parse_transform(const JsonValue& json) {
  Transform all;
  if (json.is_array()) {
    for (const JsonValue& element : json.elements()) {
      all = parse_step(element).compose(all);
    }
  } else if (json.exists()) {
    all = parse_step(json);
  }
  if (json.exists() && is_singular(all)) {
    json.error("expected a transform that can be inverted");
    return {};
  }
  return all;
}

ShapeDesc parse_shape(const JsonValue& json, const SceneNames& names, ShapePlace place) {
  ShapeDesc shape;
  shape.where = json.where();
  const bool in_group = place == ShapePlace::kGroup;
  const JsonValue type_json = json.require("type");
  const std::string type = in_group ? type_json.choice("", {"sphere", "quad", "disk", "mesh"})
                                    : type_json.choice("", {"sphere", "quad", "disk", "mesh", "instance"});
  if (type.empty()) {
    return shape;  // recorded; without a type no key is known or unknown
  }
  shape.to_world = parse_transform(json.get("transform"));
  if (!in_group) shape.name = parse_name(json.get("name"));
  if (type == "instance") {
    shape.kind = InstanceDesc{parse_reference(json.require("group"), "group", names.groups)};
    json.reject_unknown_keys();
    return shape;
  }
  if (type == "sphere") {
    shape.kind = parse_sphere(json);
  } else if (type == "quad") {
    shape.kind = parse_quad(json);
  } else if (type == "disk") {
    shape.kind = parse_disk(json);
  } else {
    shape.kind = parse_mesh(json, names);
  }
  const auto* mesh = std::get_if<MeshDesc>(&shape.kind);
  const bool brings_materials = mesh != nullptr && mesh->materials;
  shape.material = parse_reference(brings_materials ? json.get("material") : json.require("material"),
                                   "material", names.materials);
  if (const JsonValue emission = json.get("emission"); emission.exists()) {
    shape.emission = parse_spectrum(emission, SpectrumRole::kEmission);
    if (in_group) {
      emission.error("shapes inside groups cannot emit: put the shape among the scene's own");
    }
  }
  json.reject_unknown_keys();
  return shape;
}

GroupDesc parse_group(const JsonValue& json, const SceneNames& names) {
  GroupDesc group;
  group.name = parse_name(json.require("name"));
  for (const JsonValue& element : json.require("shapes").elements()) {
    group.shapes.push_back(parse_shape(element, names, ShapePlace::kGroup));
  }
  json.reject_unknown_keys();
  return group;
}

}  // namespace spectrace
