// SPDX-License-Identifier: Apache-2.0
#include "renderer/material_libraries.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/error.h"
#include "core/base/nearest.h"
#include "renderer/obj_materials.h"

namespace spectrace {

namespace {

constexpr const char* kHint = "; a shape's \"materials\" may name one of the scene for it";

}  // namespace

const std::vector<MtlMaterial>& MaterialLibraries::library(const std::filesystem::path& file,
                                                           const std::filesystem::path& obj_file) {
  if (const auto it = read_.find(file); it != read_.end()) return it->second;
  std::error_code failed;
  if (!std::filesystem::is_regular_file(file, failed)) {
    throw InputError(obj_file.string(), "",
                     fmt::format("names the material library \"{}\", which is not there{}",
                                 file.lexically_normal().string(), kHint));
  }
  return read_.emplace(file, read_mtl(file)).first->second;
}

std::vector<std::filesystem::path> MaterialLibraries::files() const {
  std::vector<std::filesystem::path> files;
  for (const auto& [file, all] : read_) {
    files.push_back(file);
    for (const MtlMaterial& mtl : all) {
      if (!found_.contains({file, mtl.name})) continue;
      for (const std::filesystem::path& map : {mtl.diffuse_map, mtl.opacity_map, mtl.normal_map}) {
        if (!map.empty()) files.push_back(map);
      }
    }
  }
  return files;
}

MaterialLibraries::Found MaterialLibraries::add(const MtlMaterial& mtl,
                                                const std::filesystem::path& library) {
  const Found found{std::uint32_t(first_index_ + materials.size()), to_emission(mtl)};
  materials.push_back(to_material(mtl));
  short_names.push_back(fmt::format("{}: {}", library.filename().string(), mtl.name));
  materials.back().name = fmt::format("{}: {}", library.string(), mtl.name);
  if (const std::vector<std::string> unheeded = without_effect(mtl); !unheeded.empty()) {
    progress_.note(fmt::format("{}: without effect: {}", materials.back().name, fmt::join(unheeded, ", ")));
  }
  return found;
}

MaterialLibraries::Found MaterialLibraries::find(const std::string& name,
                                                 const std::vector<std::filesystem::path>& libraries,
                                                 const std::filesystem::path& obj_file) {
  std::vector<std::string> known;
  for (const std::filesystem::path& file : libraries) {
    const std::pair key(file, name);
    if (const auto it = found_.find(key); it != found_.end()) return it->second;
    const std::vector<MtlMaterial>& all = library(file, obj_file);
    const auto it =
        std::find_if(all.begin(), all.end(), [&](const MtlMaterial& m) { return m.name == name; });
    if (it != all.end()) return found_.emplace(key, add(*it, file)).first->second;
    for (const MtlMaterial& m : all) known.push_back(m.name);
  }
  const std::string problem =
      libraries.empty()
          ? fmt::format("uses the material \"{}\" and names no library that could have it", name)
          : fmt::format("uses the material \"{}\", which its library does not have{}", name,
                        suggestion(name, known));
  throw InputError(obj_file.string(), "", problem + kHint);
}

}  // namespace spectrace
