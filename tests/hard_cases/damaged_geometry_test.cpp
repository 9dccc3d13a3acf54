// SPDX-License-Identifier: Apache-2.0
// H14: what cannot be hit is counted, named and left out; the rest is rendered. Through the program.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "core/image/image.h"
#include "tests/support/run_program.h"

namespace spectrace::test {
namespace {

class H14_DamagedGeometry : public ::testing::Test {
 protected:
  /// A mesh under a sky of 1, seen from above.
  ProgramResult render(const std::string& mesh) const {
    write_text(folder_ / "scene.json",
               R"({"camera": {"origin": [0, 0, 5], "target": [0, 0, 0], "up": [0, 1, 0], "fov_deg": 5},
"film": {"width": 8, "height": 8}, "sampler": {"spp": 16},
"materials": [{"name": "grey", "type": "lambert", "reflectance": 0.5}],
"shapes": [{"type": "mesh", "file": ")" +
                   mesh + R"(", "material": "grey"}],
"lights": [{"type": "environment", "radiance": 1}]})");
    ProgramResult result = run_spectrace({"scene.json", "-o", "out.exr", "--aovs", "all"}, folder_.path());
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_TRUE(result.says(" 0 invalid samples")) << result.output;
    return result;
  }
  [[nodiscard]] Image image() const { return read_image(folder_ / "out.exr"); }
  void expect_finite() const {
    for (const float x : image().data) ASSERT_TRUE(std::isfinite(x));
  }
  [[nodiscard]] double mean(const std::string& channel) const {
    const Image picture = image();
    const auto c = picture.find_channel(channel);
    double sum = 0;
    for (int y = 0; y < 8; ++y) {
      for (int x = 0; x < 8; ++x) sum += double(picture.at(x, y, c.value()));
    }
    return sum / 64;
  }

  TemporaryFolder folder_;
};

constexpr const char* kPlyHead = "ply\nformat ascii 1.0\nelement vertex ";

TEST_F(H14_DamagedGeometry, EachKindIsCountedAndTheRestIsSeen) {
  // One square of two good triangles, and one triangle of each kind.
  write_text(folder_ / "damaged.ply",
             std::string(kPlyHead) +
                 "7\nproperty float x\nproperty float y\nproperty float z\nelement face 8\n"
                 "property list uchar int vertex_indices\nend_header\n"
                 "-2 -2 0\n2 -2 0\n2 2 0\n-2 2 0\nnan 0 1\n3e18 0 1\ninf 0 0\n"
                 "3 0 1 2\n3 0 2 3\n3 0 1 4\n3 0 1 5\n3 0 1 6\n3 0 0 1\n3 1 1 1\n3 2 1 0\n");
  const ProgramResult result = render("damaged.ply");
  EXPECT_TRUE(
      result.complains("damaged.ply: 6 of 8 triangles skipped (2 not finite, 1 too large, 2 without "
                       "area, 1 duplicate)"))
      << result.errors;
  expect_finite();
  EXPECT_NEAR(mean("diffuse.G"), 0.5, 0.05);
  EXPECT_EQ(mean("background.G"), 0);
}

TEST_F(H14_DamagedGeometry, BadNormalsGiveWayToTheTrianglesOwn) {
  write_text(
      folder_ / "normals.ply",
      std::string(kPlyHead) +
          "4\nproperty float x\nproperty float y\nproperty float z\nproperty float nx\nproperty float ny\n"
          "property float nz\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n"
          "-2 -2 0 nan 0 1\n2 -2 0 0 0 0\n2 2 0 inf 0 0\n-2 2 0 0 0 1\n3 0 1 2\n3 0 2 3\n");
  const ProgramResult result = render("normals.ply");
  EXPECT_TRUE(result.complains("3 normals zero or not finite")) << result.errors;
  expect_finite();
  EXPECT_NEAR(mean("diffuse.G"), 0.5, 0.05);
  EXPECT_NEAR(mean("normal.Z"), 1, 1e-6);
}

TEST_F(H14_DamagedGeometry, AnEmptyMeshShowsTheBackground) {
  write_text(folder_ / "empty.ply",
             std::string(kPlyHead) +
                 "0\nproperty float x\nproperty float y\nproperty float z\nelement face 0\n"
                 "property list uchar int vertex_indices\nend_header\n");
  write_text(folder_ / "empty.obj", "# nothing\n");
  for (const char* mesh : {"empty.ply", "empty.obj"}) {
    const ProgramResult result = render(mesh);
    EXPECT_TRUE(result.complains(mesh)) << result.errors;
    expect_finite();
    EXPECT_GT(mean("background.G"), 0.9) << mesh;
    EXPECT_EQ(mean("diffuse.G"), 0) << mesh;
  }
}

TEST_F(H14_DamagedGeometry, AnEmptySceneShowsItsBackground) {
  write_text(folder_ / "scene.json",
             R"({"camera": {"origin": [0, 0, 5], "target": [0, 0, 0], "up": [0, 1, 0]},
"film": {"width": 8, "height": 8}, "materials": [], "shapes": []})");
  const ProgramResult result =
      run_spectrace({"scene.json", "-o", "out.exr", "--aovs", "all"}, folder_.path());
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  expect_finite();
  EXPECT_EQ(mean("G"), 0);
}

}  // namespace
}  // namespace spectrace::test
