// SPDX-License-Identifier: Apache-2.0
#include "tests/support/ply_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>

namespace spectrace::test {

namespace {

class Writer {
 public:
  explicit Writer(PlyFormat format) : format_(format) {}

  template <typename T>
  void put(T value) {
    if (format_ == PlyFormat::kText) {
      text += fmt::format("{} ", value);  // as many digits as it takes
      return;
    }
    char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof(T));
    const bool little = std::endian::native == std::endian::little;
    if (little != (format_ == PlyFormat::kLittleEndian)) std::reverse(bytes, bytes + sizeof(T));
    text.append(bytes, sizeof(T));
  }
  void end_line() {
    if (format_ == PlyFormat::kText) text.back() = '\n';
  }

  std::string text;

 private:
  PlyFormat format_;
};

}  // namespace

std::string ply_text(const TriangleMesh& mesh, PlyFormat format) {
  const char* const names[] = {"ascii", "binary_little_endian", "binary_big_endian"};
  Writer out(format);
  out.text = fmt::format("ply\nformat {} 1.0\ncomment of a test\nelement vertex {}\n", names[int(format)],
                         mesh.positions.size());
  const auto declare = [&](std::initializer_list<const char*> properties) {
    for (const char* name : properties) out.text += fmt::format("property float {}\n", name);
  };
  declare({"x", "y", "z"});
  if (!mesh.normals.empty()) declare({"nx", "ny", "nz"});
  if (!mesh.uvs.empty()) declare({"u", "v"});
  out.text += fmt::format("element face {}\nproperty list uchar int vertex_indices\nend_header\n",
                          mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const auto put = [&](Vec3 v) {
      for (Float x : {v.x, v.y, v.z}) out.put(float(x));
    };
    put(mesh.positions[i]);
    if (!mesh.normals.empty()) put(mesh.normals[i]);
    if (!mesh.uvs.empty()) {
      out.put(float(mesh.uvs[i].x));
      out.put(float(mesh.uvs[i].y));
    }
    out.end_line();
  }
  for (const auto& triangle : mesh.triangles) {
    out.put(std::uint8_t(3));
    for (std::uint32_t index : triangle) out.put(std::int32_t(index));
    out.end_line();
  }
  return out.text;
}

}  // namespace spectrace::test
