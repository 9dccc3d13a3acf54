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

/// The axis: a direction, or towards a target.
Vec3 parse_axis(const JsonValue& json, Vec3 position, Vec3 fallback) {
  const JsonValue direction = json.get("direction"), target = json.get("target");
  if (direction.exists() == target.exists()) {
    json.error("a spot light needs a \"direction\" or a \"target\", and not both");
    return fallback;
  }
  if (direction.exists()) return normalize(parse_nonzero(direction, fallback));
  const Vec3 at = target.vec3(position + fallback);
  if (at == position) {
    target.error("is the same point as the position: the light shines nowhere");
    return fallback;
  }
  return normalize(at - position);
}

SpotLightDesc parse_spot(const JsonValue& json) {
  SpotLightDesc spot;
  spot.position = json.require("position").vec3({});
  spot.direction = parse_axis(json, spot.position, spot.direction);
  spot.intensity = parse_spectrum(json.require("intensity"), SpectrumRole::kEmission);
  const NumberRange cone{.min = 0, .max = 180, .min_open = true};
  spot.cone_deg = static_cast<Float>(json.require("cone_deg").number(spot.cone_deg, cone));
  const JsonValue falloff = json.get("falloff_deg");
  // Where a beam begins to fade when nothing is said: as in Mitsuba, whose beam_width is 3/4 of its cutoff.
  spot.falloff_deg = static_cast<Float>(falloff.number(spot.cone_deg * Float(0.75), {.min = 0, .max = 180}));
  if (spot.falloff_deg > spot.cone_deg) {
    falloff.error("must not exceed cone_deg: the light fades between the two angles");
  }
  return spot;
}

}  // namespace

LightDesc parse_light(const JsonValue& json) {
  const std::string type = json.require("type").choice("", {"environment", "point", "spot", "directional"});
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
  } else if (type == "spot") {
    light = parse_spot(json);
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
