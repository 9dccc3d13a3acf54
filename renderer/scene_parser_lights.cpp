// SPDX-License-Identifier: Apache-2.0
// Lights of a scene file that are no shapes.
#include <cmath>

#include "renderer/scene_parser.h"

namespace spectrace {
namespace {

// How far a rotation's columns may be from orthonormal: 10 roundings of single precision.
constexpr Float kRotationTolerance = Float(1e-6);

bool is_rotation(const Transform& t) {
  const Vec3 x = t.vector({1, 0, 0}), y = t.vector({0, 1, 0}), z = t.vector({0, 0, 1});
  const auto near = [](Float a, Float b) { return std::abs(a - b) <= kRotationTolerance; };
  return near(dot(x, x), 1) && near(dot(y, y), 1) && near(dot(z, z), 1) && near(dot(x, y), 0) &&
         near(dot(y, z), 0) && near(dot(z, x), 0) && t.determinant() > 0 && t.point({}) == Vec3{};
}

EnvironmentDesc parse_environment(const JsonValue& json) {
  EnvironmentDesc light;
  const JsonValue file = json.get("file"), radiance = json.get("radiance"), transform = json.get("transform");
  if (file.exists()) {
    light.file = parse_existing_file(file);
  } else if (!radiance.exists()) {
    json.error("an environment needs a \"file\", a \"radiance\", or both");
  }
  // An image is light already: multiplied by another light's spectrum it would carry the illuminant twice.
  light.radiance = parse_spectrum(radiance, file.exists() ? SpectrumRole::kFactor : SpectrumRole::kEmission,
                                  light.radiance);
  light.scale = static_cast<Float>(json.get("scale").number(light.scale, kNonNegativeFloat));
  light.to_world = parse_transform(transform);
  if (!is_rotation(light.to_world)) {
    transform.error("an environment can only be rotated");
  }
  return light;
}

}  // namespace

LightDesc parse_light(const JsonValue& json) {
  const std::string type = json.require("type").choice("", {"environment", "point", "directional"});
  if (type.empty()) {
    return PointLightDesc{};  // recorded; without a type no key is known or unknown
  }
  LightDesc light;
  if (type == "environment") {
    light = parse_environment(json);
  } else if (type == "point") {
    PointLightDesc point;
    point.position = json.require("position").vec3({});
    point.intensity = parse_spectrum(json.require("intensity"), SpectrumRole::kEmission);
    light = point;
  } else {
    DirectionalLightDesc directional;
    directional.direction = normalize(parse_nonzero(json.require("direction"), directional.direction));
    directional.irradiance = parse_spectrum(json.require("irradiance"), SpectrumRole::kEmission);
    light = directional;
  }
  json.reject_unknown_keys();
  return light;
}

}  // namespace spectrace
