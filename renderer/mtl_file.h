// SPDX-License-Identifier: Apache-2.0
// Material libraries of OBJ files (MTL), as they say it: which of it has an effect, and what else is there.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/spectra/spectrum.h"

namespace spectrace {

/// One "newmtl" with the statements that are understood; those that are absent have no value.
struct MtlMaterial {
  std::string name;
  std::optional<Rgb> diffuse, specular, emission;              ///< Kd, Ks in [0, 1], Ke >= 0
  std::optional<double> exponent;                              ///< Ns >= 0
  std::optional<double> roughness, metallic;                   ///< Pr, Pm in [0, 1]
  std::optional<double> opacity;                               ///< d, or 1 - Tr, in [0, 1]
  std::optional<double> refractive_index;                      ///< Ni > 0
  int illumination = 2;                                        ///< illum
  std::filesystem::path diffuse_map, opacity_map, normal_map;  ///< map_Kd, map_d, norm; empty: none
  std::vector<std::string> without_effect;                     ///< other statements, once each: "map_Bump"
};

/// File names are relative to the library's folder. Throws InputError with every line that is wrong, and
/// where a map's file is not there.
[[nodiscard]] std::vector<MtlMaterial> read_mtl(const std::filesystem::path& file);

}  // namespace spectrace
