// SPDX-License-Identifier: Apache-2.0
#include "renderer/ply_file.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>

#include "core/base/error.h"
#include "renderer/mesh.h"
#include "tests/support/ply_writer.h"

namespace spectrace::test {
namespace {

std::filesystem::path write(const std::string& text) {
  const auto file = std::filesystem::path(testing::TempDir()) / "ply_file_test.ply";
  std::ofstream(file, std::ios::binary) << text;
  return file;
}

/// What is wrong with it, without the file's name; empty where nothing is.
std::string problem_of(const std::string& text) {
  const auto file = write(text);
  try {
    (void)read_ply(file);
  } catch (const InputError& e) {
    EXPECT_EQ(e.diagnostics().size(), 1U);
    const Diagnostic& d = e.diagnostics()[0];
    EXPECT_EQ(d.file, file.string());
    return d.where.empty() ? d.problem : d.where + ": " + d.problem;
  }
  return "";
}

TriangleMesh small_mesh() {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, Float(0.1), 0}, {1, 1, Float(-1e-20)}, {0, 1, Float(12345.678)}};
  mesh.normals = {{0, 0, 1}, {0, 1, 0}, {1, 0, 0}, {0, 0, -1}};
  mesh.uvs = {{0, 0}, {Float(0.3), 0}, {1, 1}, {0, Float(2.5)}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

void expect_equal(const TriangleMesh& a, const TriangleMesh& b) {
  EXPECT_EQ(a.triangles, b.triangles);
  EXPECT_EQ(a.positions, b.positions);
  EXPECT_EQ(a.normals, b.normals);
  ASSERT_EQ(a.uvs.size(), b.uvs.size());
  for (std::size_t i = 0; i < a.uvs.size(); ++i) {
    EXPECT_EQ(a.uvs[i].x, b.uvs[i].x);
    EXPECT_EQ(a.uvs[i].y, b.uvs[i].y);
  }
}

constexpr std::array kFormats{PlyFormat::kText, PlyFormat::kLittleEndian, PlyFormat::kBigEndian};

TEST(PlyFile, EveryFormatHoldsTheSameMesh) {
  TriangleMesh bare = small_mesh();
  bare.normals.clear();
  bare.uvs.clear();
  for (PlyFormat format : kFormats) {
    for (const TriangleMesh& mesh : {small_mesh(), bare}) {
      const auto file = write(ply_text(mesh, format));
      EXPECT_TRUE(is_ply(file));
      expect_equal(read_ply(file), mesh);
      expect_equal(read_mesh(file), mesh);  // by what it holds, whatever its name
    }
  }
}

// As other programs write them: names, types, elements and properties of no interest, lines that end in \r\n.
TEST(PlyFile, TakesWhatOtherProgramsWrite) {
  const std::string text =
      "ply\r\nformat ascii 1.0\r\ncomment by hand\r\nobj_info x\r\n"
      "element camera 1\r\nproperty list uchar float of\r\nproperty int id\r\n"
      "element vertex 5\r\nproperty uchar red\r\nproperty double z\r\nproperty double y\r\nproperty double "
      "x\r\n"
      "property float s\r\nproperty float t\r\nproperty float nx\r\n"
      "element face 2\r\nproperty uchar flags\r\nproperty list uint8 uint32 vertex_index\r\n"
      "element edge 1\r\nproperty int vertex1\r\nend_header\r\n"
      "3 1 2 3 7\r\n"
      "255 0 0 0 0 0 1\r\n255 0 0 1 1 0 1\r\n255 0 1 1 1 1 1\r\n255 0 1 0 0 1 1\r\n255 9e-1 +0.5 0 0 0 1\r\n"
      "0 4 0 1 2 3\r\n0 3 0 1 4\r\n17";
  const TriangleMesh mesh = read_ply(write(text));
  ASSERT_EQ(mesh.positions.size(), 5U);
  EXPECT_EQ(mesh.positions[1], (Vec3{1, 0, 0}));
  EXPECT_EQ(mesh.positions[4], (Vec3{0, Float(0.5), Float(0.9)}));
  EXPECT_TRUE(mesh.normals.empty());  // nx alone is none
  EXPECT_EQ(mesh.uvs.at(2).y, 1);
  const std::vector<std::array<std::uint32_t, 3>> expected{{0, 1, 2}, {0, 2, 3}, {0, 1, 4}};
  EXPECT_EQ(mesh.triangles, expected);
}

std::string with(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), by);
}

TEST(PlyFile, NamesTheLineOrByteOfWhatIsWrong) {
  const std::string text = ply_text(small_mesh(), PlyFormat::kText);
  const std::string binary = ply_text(small_mesh(), PlyFormat::kLittleEndian);
  EXPECT_EQ(problem_of(text), "");
  EXPECT_EQ(problem_of("solid\n"), "line 1: is not a PLY file: it does not begin with \"ply\"");
  EXPECT_EQ(problem_of("ply\nformat ascii 1.0\n"), "line 3: the file ends within its header");
  EXPECT_EQ(
      problem_of(with(text, "ascii", "utf8")),
      "line 2: expected \"format\", one of ascii, binary_little_endian, binary_big_endian, and \"1.0\"");
  EXPECT_EQ(problem_of(with(text, "vertex 4", "vertex -4")),
            "line 4: expected a count of elements, got \"-4\"");
  EXPECT_EQ(problem_of(with(text, "float x", "flout x")), "line 5: there is no type \"flout\"");
  EXPECT_EQ(problem_of(with(text, "float y", "float x")), "line 6: a second property \"x\"");
  EXPECT_EQ(problem_of(with(text, "comment of", "command of")),
            "line 3: expected element, property, comment or end_header, got \"command\"");
  EXPECT_EQ(problem_of(with(text, "element vertex", "property float w\nelement vertex")),
            "line 4: a property before the first element");
  EXPECT_EQ(problem_of(with(text, "float z", "float zed")), "its vertices have no x, y, z");
  EXPECT_EQ(problem_of(with(text, "vertex_indices", "corners")), "its faces have no list \"vertex_indices\"");
  EXPECT_EQ(problem_of(with(text, "element face", "element farce")),
            "has no faces: a cloud of points or strips of triangles cannot be rendered");
  EXPECT_EQ(problem_of(with(text, "element vertex", "element vortex")), "has no vertices");
  EXPECT_EQ(problem_of(with(text, "12345.678", "12345.67b")),
            "line 19: expected a number, got \"12345.67b\"");
  EXPECT_EQ(problem_of(with(text, "3 0 1 2", "3 0 1 4")),
            "line 20: a face names vertex 4 of 4, which are counted from 0");
  EXPECT_EQ(problem_of(with(text, "3 0 1 2", "3 0 -1 2")),
            "line 20: a face names vertex -1 of 4, which are counted from 0");
  EXPECT_EQ(problem_of(with(text, "3 0 1 2", "2 0 1 2")), "line 20: a face with 2 corners");
  EXPECT_EQ(problem_of(with(text, "3 0 1 2", "3.5 0 1 2")),
            "line 20: expected the length of a list, got 3.5");
  EXPECT_EQ(problem_of(text.substr(0, text.size() - 3)), "line 21: the file ends within its data");
  const std::size_t data = binary.find("end_header\n") + 11;
  EXPECT_EQ(problem_of(binary.substr(0, binary.size() - 2)),
            "byte " + std::to_string(binary.size() - 4) + ": the file ends within its data");
  std::string bad = binary;
  bad[data + 4 * 32 + 1] = 9;  // the first face's first index
  EXPECT_EQ(problem_of(bad), "byte " + std::to_string(data + 4 * 32 + 1) +
                                 ": a face names vertex 9 of 4, which are counted from 0");
  EXPECT_THROW((void)read_ply("/nowhere/x.ply"), InputError);
}

TEST(PlyFile, PromisesOfItsHeaderCostNoMemory) {
  for (const char* count : {"4000000000", "18446744073709551615", "100"}) {
    for (PlyFormat format : kFormats) {
      const std::string text = ply_text(small_mesh(), format);
      EXPECT_NE(problem_of(with(text, "vertex 4", std::string("vertex ") + count)), "");
      EXPECT_NE(problem_of(with(text, "face 2", std::string("face ") + count)).find("the file is too short"),
                std::string::npos);
      EXPECT_NE(
          problem_of(with(text, "element face", std::string("element nothing ") + count + "\nelement face"))
              .find("has no properties"),
          std::string::npos);
    }
  }
  // A list that promises four thousand million numbers.
  EXPECT_EQ(
      problem_of(
          "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
          "element face 1\nproperty list uint int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n"
          "4294967295 0 1 2\n"),
      "line 14: the file ends within its data");
}

TEST(PlyFile, NoDamageGoesFurtherThanAMessage) {
  for (PlyFormat format : kFormats) {
    const std::string text = ply_text(small_mesh(), format);
    for (std::size_t i = 0; i < text.size(); ++i) {
      if (format != PlyFormat::kText || i + 2 < text.size()) {  // a text's last line need not end
        EXPECT_NE(problem_of(text.substr(0, i)), "") << i;
      }
      for (char change : {'\x01', '\x90'}) {
        std::string damaged = text;
        damaged[i] = char(damaged[i] ^ change);
        try {
          const TriangleMesh mesh = read_ply(write(damaged));
          for (const auto& triangle : mesh.triangles) {
            for (std::uint32_t index : triangle) ASSERT_LT(index, mesh.positions.size());
          }
        } catch (const InputError&) {  // said so: all that is asked for
        }
      }
    }
  }
}

}  // namespace
}  // namespace spectrace::test
