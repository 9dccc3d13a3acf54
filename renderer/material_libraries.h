// SPDX-License-Identifier: Apache-2.0
// The materials that OBJ files bring along: a part of build_scene().
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/progress.h"
#include "materials/material.h"
#include "renderer/mtl_file.h"

namespace spectrace {

/// Reads each library once, and makes each of its materials at most once, when it is asked for.
class MaterialLibraries {
 public:
  /// `first_index`: how many materials the scene has of its own.
  MaterialLibraries(std::size_t first_index, Progress& progress)
      : first_index_(first_index), progress_(progress) {}

  struct Found {
    std::uint32_t index = 0;  ///< among the scene's own materials and then these
    std::optional<Spectrum> emission;
  };
  /// `name` in the first of `libraries` that has it. Throws InputError, naming `obj_file`, where none does.
  Found find(const std::string& name, const std::vector<std::filesystem::path>& libraries,
             const std::filesystem::path& obj_file);

  /// Libraries read, and the images that materials made of them name.
  [[nodiscard]] std::vector<std::filesystem::path> files() const;

  std::vector<MaterialDesc> materials;
  std::vector<std::string> short_names;  ///< theirs, without folders: the same wherever the scene lies

 private:
  const std::vector<MtlMaterial>& library(const std::filesystem::path& file,
                                          const std::filesystem::path& obj_file);
  Found add(const MtlMaterial& mtl, const std::filesystem::path& library);

  std::size_t first_index_;
  Progress& progress_;
  std::map<std::filesystem::path, std::vector<MtlMaterial>> read_;
  std::map<std::pair<std::filesystem::path, std::string>, Found> found_;
};

}  // namespace spectrace
