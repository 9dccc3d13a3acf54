// SPDX-License-Identifier: Apache-2.0
#include "renderer/obj_file.h"

#include <fmt/core.h>
#include <tiny_obj_loader.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <sstream>
#include <string_view>
#include <unordered_map>

#include "core/base/error.h"
#include "renderer/trimmed.h"
#include "renderer/words_hash.h"

namespace spectrace {

namespace {

using VertexKey = std::array<int, 3>;  // position, texture coordinate, normal; -1: none

Vec3 triple(const std::vector<tinyobj::real_t>& values, int index) {
  const std::size_t i = std::size_t(index) * 3;
  return {Float(values[i]), Float(values[i + 1]), Float(values[i + 2])};
}

/// Gives every combination of indices a vertex of its own.
class ObjWelder {
 public:
  ObjWelder(const tinyobj::attrib_t& attributes, std::string file)
      : attributes_(attributes), file_(std::move(file)) {
    has_normals_ = !attributes.normals.empty();
    has_uvs_ = !attributes.texcoords.empty();
  }

  std::uint32_t vertex(const tinyobj::index_t& index) {
    const auto outside = [](int i, std::size_t numbers, std::size_t per) { return i >= int(numbers / per); };
    if (index.vertex_index < 0 || outside(index.vertex_index, attributes_.vertices.size(), 3) ||
        outside(index.normal_index, attributes_.normals.size(), 3) ||
        outside(index.texcoord_index, attributes_.texcoords.size(), 2)) {
      throw InputError(
          file_, "",
          fmt::format("a face names vertex {}, which the file does not have", index.vertex_index + 1));
    }
    const VertexKey key{index.vertex_index, index.texcoord_index, index.normal_index};
    const auto [it, is_new] = known_.try_emplace(key, std::uint32_t(mesh.positions.size()));
    if (is_new) {
      mesh.positions.push_back(triple(attributes_.vertices, key[0]));
      if (has_uvs_) {
        const std::size_t i = std::size_t(std::max(key[1], 0)) * 2;
        mesh.uvs.push_back(
            key[1] < 0 ? Vec2{} : Vec2{Float(attributes_.texcoords[i]), Float(attributes_.texcoords[i + 1])});
      }
      if (has_normals_) {
        mesh.normals.push_back(key[2] < 0 ? Vec3{} : triple(attributes_.normals, key[2]));
      }
    }
    return it->second;
  }

  TriangleMesh mesh;

 private:
  const tinyobj::attrib_t& attributes_;
  std::string file_;
  bool has_normals_ = false, has_uvs_ = false;
  std::unordered_map<VertexKey, std::uint32_t, WordsHash> known_;
};

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

struct Parsed {
  tinyobj::attrib_t attributes;
  std::vector<tinyobj::shape_t> shapes;
  std::string error;  // empty: all is well
};

Parsed parse_obj(std::istream& stream, tinyobj::MaterialReader* materials) {
  Parsed parsed;
  std::vector<tinyobj::material_t> unused;
  std::string warning;
  constexpr bool kTriangulate = true, kVertexColors = false;
  const bool ok = tinyobj::LoadObj(&parsed.attributes, &parsed.shapes, &unused, &warning, &parsed.error,
                                   &stream, materials, kTriangulate, kVertexColors);
  if (!ok && parsed.error.empty()) parsed.error = "is not an OBJ file";
  return parsed;
}

/// What a file says of materials, before its faces are read.
struct MaterialStatements {
  std::vector<std::string> used, libraries;  // in order of first use
};

MaterialStatements scan_materials(const std::string& text) {
  MaterialStatements found;
  const auto add = [](std::vector<std::string>& list, std::string_view name) {
    if (!name.empty() && std::find(list.begin(), list.end(), name) == list.end()) list.emplace_back(name);
  };
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line = trimmed(std::string_view(text).substr(begin, end - begin));
    constexpr std::string_view kUse = "usemtl", kLibrary = "mtllib";
    const auto follows = [&](std::string_view keyword) {
      return line.starts_with(keyword) && line.size() > keyword.size() &&
             kBlanks.find(line[keyword.size()]) != kBlanks.npos;
    };
    if (follows(kUse)) add(found.used, trimmed(line.substr(kUse.size())));
    if (follows(kLibrary)) add(found.libraries, trimmed(line.substr(kLibrary.size())));
    begin = end + 1;
  }
  return found;
}

/// Numbers the materials as they are given, instead of opening libraries.
class NumberedMaterials final : public tinyobj::MaterialReader {
 public:
  explicit NumberedMaterials(std::map<std::string, int> numbers) : numbers_(std::move(numbers)) {}
  bool operator()(const std::string&, std::vector<tinyobj::material_t>*, std::map<std::string, int>* numbers,
                  std::string*, std::string*) override {
    *numbers = numbers_;
    return true;
  }

 private:
  std::map<std::string, int> numbers_;
};

/// tinyobjloader knows a material by the first word of its name.
std::map<std::string, int> number_materials(const std::vector<std::string>& names, const std::string& file) {
  std::map<std::string, int> numbers;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string word = names[i].substr(0, names[i].find_first_of(kBlanks));
    if (!numbers.emplace(word, int(i)).second) {
      throw InputError(file, "",
                       fmt::format("two materials whose names begin with \"{}\" and a blank", word));
    }
  }
  return numbers;
}

void add_faces(const tinyobj::mesh_t& mesh, std::size_t first_face, std::size_t last_face,
               ObjWelder& welder) {
  for (std::size_t face = first_face; face < last_face && 3 * face + 2 < mesh.indices.size(); ++face) {
    const std::uint32_t a = welder.vertex(mesh.indices[3 * face]);
    const std::uint32_t b = welder.vertex(mesh.indices[3 * face + 1]);
    const std::uint32_t c = welder.vertex(mesh.indices[3 * face + 2]);
    welder.mesh.triangles.push_back({a, b, c});
  }
}

/// One name with blanks, if there is such a file, or several.
void add_libraries(std::string_view names, const std::filesystem::path& folder,
                   std::vector<std::filesystem::path>& libraries) {
  std::error_code failed;
  if (std::filesystem::is_regular_file(folder / names, failed)) {
    libraries.push_back(folder / names);
    return;
  }
  while (!names.empty()) {
    const std::string_view name = names.substr(0, names.find_first_of(kBlanks));
    libraries.push_back(folder / name);
    names = trimmed(names.substr(name.size()));
  }
}

std::ifstream open(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) {
    throw InputError(file.string(), "", "cannot be opened");
  }
  return stream;
}

}  // namespace

TriangleMesh read_obj(const std::filesystem::path& file) {
  std::ifstream stream = open(file);
  // No material reader: materials are the scene's, and a mesh may not open further files.
  const Parsed parsed = parse_obj(stream, nullptr);
  if (!parsed.error.empty()) {
    throw InputError(file.string(), "", first_line(parsed.error));
  }
  ObjWelder welder(parsed.attributes, file.string());
  for (const tinyobj::shape_t& shape : parsed.shapes) {
    add_faces(shape.mesh, 0, shape.mesh.indices.size() / 3, welder);
  }
  return std::move(welder.mesh);
}

ObjGroups read_obj_groups(const std::filesystem::path& file) {
  std::ostringstream text;
  text << open(file).rdbuf();
  const MaterialStatements statements = scan_materials(text.str());
  NumberedMaterials numbered(number_materials(statements.used, file.string()));
  // Materials get their numbers when a library is named: here before all else, whether the file names one or
  // not.
  std::istringstream stream("mtllib materials\n" + text.str());
  const Parsed parsed = parse_obj(stream, &numbered);
  if (!parsed.error.empty()) {
    (void)read_obj(file);  // says what is wrong, with the file's own line numbers
    throw InputError(file.string(), "", first_line(parsed.error));
  }
  // By material; number -1, faces without one, comes first.
  std::vector<ObjWelder> welders(statements.used.size() + 1, ObjWelder(parsed.attributes, file.string()));
  for (const tinyobj::shape_t& shape : parsed.shapes) {
    const std::vector<int>& materials = shape.mesh.material_ids;
    for (std::size_t face = 0; face < materials.size(); ++face) {
      add_faces(shape.mesh, face, face + 1, welders[std::size_t(materials[face] + 1)]);
    }
  }
  ObjGroups result;
  for (std::size_t i = 0; i < welders.size(); ++i) {
    if (welders[i].mesh.triangles.empty()) continue;
    result.groups.push_back({i == 0 ? "" : statements.used[i - 1], std::move(welders[i].mesh)});
  }
  for (const std::string& names : statements.libraries) {
    add_libraries(names, file.parent_path(), result.libraries);
  }
  return result;
}

}  // namespace spectrace
