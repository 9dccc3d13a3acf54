// SPDX-License-Identifier: Apache-2.0
#include "renderer/ply_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <fstream>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "renderer/ply_header.h"

namespace spectrace {

namespace {

using ply::Element;
using ply::Encoding;
using ply::Header;
using ply::Property;
using ply::Source;
using ply::Type;

/// The numbers after the header, one by one.
class Body {
 public:
  Body(Source& source, Encoding encoding) : source_(source), encoding_(encoding) {}

  double number(Type type) {
    if (encoding_ == Encoding::kText) return text_number();
    at_ = source_.position();
    switch (type) {
      case Type::kInt8:
        return binary<std::int8_t>();
      case Type::kUint8:
        return binary<std::uint8_t>();
      case Type::kInt16:
        return binary<std::int16_t>();
      case Type::kUint16:
        return binary<std::uint16_t>();
      case Type::kInt32:
        return binary<std::int32_t>();
      case Type::kUint32:
        return binary<std::uint32_t>();
      case Type::kFloat32:
        return binary<float>();
      case Type::kFloat64:
        return binary<double>();
    }
    return 0;
  }
  std::uint64_t list_length(const Property& list) {
    const double length = number(*list.list_length);
    if (!(length >= 0 && length <= 0xffffffffU && length == std::floor(length))) {
      fail(fmt::format("expected the length of a list, got {}", length));
    }
    return static_cast<std::uint64_t>(length);
  }
  void skip(const Property& property) {
    const std::uint64_t values = property.list_length ? list_length(property) : 1;
    for (std::uint64_t i = 0; i < values; ++i) number(property.type);
  }
  /// Where the number just read stands.
  [[noreturn]] void fail(std::string problem) const {
    if (encoding_ == Encoding::kText) source_.fail_at_word(std::move(problem));
    source_.fail_at_byte(at_, std::move(problem));
  }
  /// Each element takes some bytes: a file too short for what its header promises is refused before memory is
  /// asked for.
  void expect_room(const Element& element) const {
    std::uint64_t least = 0;
    for (const Property& p : element.properties) {
      least +=
          encoding_ == Encoding::kText ? 2 : size_of(p.list_length.value_or(p.type));  // a digit, a blank
    }
    if (least == 0) source_.fail(fmt::format("element \"{}\" has no properties", element.name));
    const std::uint64_t room = (source_.remaining() + 1) / least;  // the last line need not end
    if (element.count > room) {
      source_.fail(fmt::format("its header promises {} of \"{}\", the file is too short for more than {}",
                               element.count, element.name, room));
    }
  }

 private:
  double text_number() {
    std::string_view word = source_.word();
    if (word.starts_with('+')) word.remove_prefix(1);  // which from_chars() does not take
    double value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size()) {
      source_.fail_at_word(fmt::format("expected a number, got \"{}\"", word));
    }
    return value;
  }
  template <typename T>
  double binary() {
    std::array<char, sizeof(T)> bytes;
    source_.bytes(bytes);
    constexpr bool kHereLittle = std::endian::native == std::endian::little;
    if ((encoding_ == Encoding::kLittleEndian) != kHereLittle) std::reverse(bytes.begin(), bytes.end());
    return double(std::bit_cast<T>(bytes));
  }

  Source& source_;
  Encoding encoding_;
  std::uint64_t at_ = 0;
};

/// Which property holds which part of a vertex.
struct VertexLayout {
  static constexpr std::size_t kParts = 8;  // x y z, nx ny nz, u v
  std::array<std::optional<std::size_t>, kParts> property;
  std::vector<std::optional<std::size_t>> part;  // by property

  VertexLayout(const Element& vertex, const Source& source) : part(vertex.properties.size()) {
    take(vertex, {"x", "y", "z"}, 0);
    if (!has(0, 3)) source.fail("its vertices have no x, y, z");
    take(vertex, {"nx", "ny", "nz"}, 3);
    constexpr std::array<std::array<std::string_view, 2>, 4> kUvNames{
        {{"s", "t"}, {"u", "v"}, {"texture_u", "texture_v"}, {"texture_s", "texture_t"}}};
    for (const auto& [u, v] : kUvNames) {
      if (!has(6, 8)) take(vertex, {u, v}, 6);
    }
    for (std::size_t i = 0; i < kParts; ++i) {
      if (property[i]) part[*property[i]] = i;
    }
  }
  [[nodiscard]] bool has(std::size_t first, std::size_t last) const {
    return std::all_of(&property[first], &property[first] + (last - first),
                       [](const auto& p) { return p.has_value(); });
  }

 private:
  void take(const Element& vertex, std::initializer_list<std::string_view> names, std::size_t first) {
    for (std::string_view name : names) {
      const auto index = vertex.find(name);
      property[first++] = index && !vertex.properties[*index].list_length ? index : std::nullopt;
    }
  }
};

void read_vertices(const Element& vertex, const Source& source, Body& body, TriangleMesh& mesh) {
  const VertexLayout layout(vertex, source);
  const bool has_normals = layout.has(3, 6), has_uvs = layout.has(6, 8);
  mesh.positions.reserve(vertex.count);
  if (has_normals) mesh.normals.reserve(vertex.count);
  if (has_uvs) mesh.uvs.reserve(vertex.count);
  std::array<Float, VertexLayout::kParts> v{};
  for (std::uint64_t i = 0; i < vertex.count; ++i) {
    for (std::size_t p = 0; p < vertex.properties.size(); ++p) {
      if (const auto part = layout.part[p]) {
        v[*part] = static_cast<Float>(body.number(vertex.properties[p].type));
      } else {
        body.skip(vertex.properties[p]);
      }
    }
    mesh.positions.push_back({v[0], v[1], v[2]});
    if (has_normals) mesh.normals.push_back({v[3], v[4], v[5]});
    if (has_uvs) mesh.uvs.push_back({v[6], v[7]});
  }
}

void read_polygon(const Property& list, std::uint64_t vertices, Body& body, TriangleMesh& mesh) {
  const std::uint64_t corners = body.list_length(list);
  if (corners < 3) body.fail(fmt::format("a face with {} corners", corners));
  std::array<std::uint32_t, 3> fan{};  // first corner, last one, this one
  for (std::uint64_t i = 0; i < corners; ++i) {
    const double index = body.number(list.type);
    if (!(index >= 0 && index < double(vertices) && index == std::floor(index))) {
      body.fail(fmt::format("a face names vertex {} of {}, which are counted from 0", index, vertices));
    }
    fan[1] = fan[2];
    fan[2] = static_cast<std::uint32_t>(index);
    if (i == 0) fan[0] = fan[2];
    if (i >= 2) mesh.triangles.push_back(fan);
  }
}

void read_faces(const Element& face, std::size_t indices, std::uint64_t vertices, Body& body,
                TriangleMesh& mesh) {
  mesh.triangles.reserve(face.count);
  for (std::uint64_t i = 0; i < face.count; ++i) {
    for (std::size_t p = 0; p < face.properties.size(); ++p) {
      if (p == indices) {
        read_polygon(face.properties[p], vertices, body, mesh);
      } else {
        body.skip(face.properties[p]);
      }
    }
  }
}

/// The property of faces that lists their vertices.
std::size_t find_indices(const Element& face, const Source& source) {
  for (std::string_view name : {"vertex_indices", "vertex_index"}) {
    const auto index = face.find(name);
    if (index && face.properties[*index].list_length) return *index;
  }
  source.fail("its faces have no list \"vertex_indices\"");
}

}  // namespace

bool is_ply(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::array<char, 4> begin{};
  stream.read(begin.data(), begin.size());
  return std::string_view(begin.data(), 3) == "ply" && (begin[3] == '\n' || begin[3] == '\r');
}

TriangleMesh read_ply(const std::filesystem::path& file) {
  Source source(file);
  const Header header = ply::read_header(source);
  const Element* const vertex = header.find("vertex");
  const Element* const face = header.find("face");
  if (vertex == nullptr) source.fail("has no vertices");
  if (face == nullptr)
    source.fail("has no faces: a cloud of points or strips of triangles cannot be rendered");
  if (vertex->count >= kNone) source.fail("has more vertices than 32 bits can number");
  const std::size_t indices = find_indices(*face, source);
  Body body(source, header.encoding);
  TriangleMesh mesh;
  for (const Element& element : header.elements) {
    if (element.count == 0) continue;
    body.expect_room(element);
    if (&element == vertex) {
      read_vertices(element, source, body, mesh);
    } else if (&element == face) {
      read_faces(element, indices, vertex->count, body, mesh);
    } else {
      for (std::uint64_t i = 0; i < element.count; ++i) {
        for (const Property& property : element.properties) body.skip(property);
      }
    }
  }
  return mesh;
}

}  // namespace spectrace
