// SPDX-License-Identifier: Apache-2.0
// The parts of the scene parser: each turns one JSON place into plain data and records what is wrong there.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "core/base/json.h"
#include "renderer/scene_desc.h"

namespace spectrace {

/// What a Float can hold: larger numbers would become infinite on the light path.
inline constexpr double kLargestFloat = std::numeric_limits<Float>::max();
inline constexpr NumberRange kPositiveFloat{.min = 0, .max = kLargestFloat, .min_open = true};
inline constexpr NumberRange kNonNegativeFloat{.min = 0, .max = kLargestFloat};

/// Of light that a lens or a grating would be built for; the observer sees 360 to 830 nm of it.
inline constexpr NumberRange kWavelengths{.min = 100, .max = 10000};

/// What shapes may refer to.
struct SceneNames {
  std::vector<std::string> materials, groups;
};

enum class ShapePlace { kScene, kGroup };

ShapeDesc parse_shape(const JsonValue& json, const SceneNames& names, ShapePlace place);
GroupDesc parse_group(const JsonValue& json, const SceneNames& names);
LightDesc parse_light(const JsonValue& json);
void parse_film(const JsonValue& json, FilmDesc& film);
/// The film's "spectral", once the scene's range is known.
void parse_spectral_film(const JsonValue& json, SceneDesc& scene);
/// A name of renderer/aovs.h, or a list of them.
void parse_aovs(const JsonValue& json, SceneDesc& scene);
/// An object with one of translate, rotate, scale, matrix, or a list of them, the first applied first.
Transform parse_transform(const JsonValue& json);

/// The value as a file name; recorded where no such file is there.
std::filesystem::path parse_existing_file(const JsonValue& json);
/// A vector of any length but zero; `fallback` where it is not.
Vec3 parse_nonzero(const JsonValue& json, Vec3 fallback);

}  // namespace spectrace
