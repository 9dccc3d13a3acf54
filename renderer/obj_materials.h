// SPDX-License-Identifier: Apache-2.0
// What a material of an OBJ file's library means here (docs/scene-format.md has the table).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "materials/material.h"
#include "renderer/mtl_file.h"

namespace spectrace {

/// Its maps are read. Throws InputError where one cannot be.
[[nodiscard]] MaterialDesc to_material(const MtlMaterial& mtl);
/// What of it goes unheeded: "map_Bump".
[[nodiscard]] std::vector<std::string> without_effect(const MtlMaterial& mtl);
/// Radiance of the front side; nothing where Ke is absent or black.
[[nodiscard]] std::optional<Spectrum> to_emission(const MtlMaterial& mtl);

}  // namespace spectrace
