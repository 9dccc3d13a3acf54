// SPDX-License-Identifier: Apache-2.0
#include "core/image/data_texture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/base/error.h"
#include "tests/support/temporary_folder.h"

namespace spectrace {
namespace {

Image one_pixel(std::vector<std::string> channels, std::vector<float> values) {
  Image image(1, 1, std::move(channels));
  image.data = std::move(values);
  return image;
}

class DataTextureFile : public ::testing::Test {
 protected:
  /// What the forms read in a document that stands in the folder.
  template <typename Parse>
  auto parse(const std::string& text, const Parse& parse_value, const std::string& problem = "") {
    JsonDocument document =
        JsonDocument::parse("{\"t\": " + text + "}", (folder_.path() / "t.json").string());
    auto texture = parse_value(document.root().get("t"));
    EXPECT_EQ(document.diagnostics().size(), problem.empty() ? 0U : 1U) << text;
    for (const Diagnostic& d : document.diagnostics()) {
      EXPECT_NE(d.problem.find(problem), std::string::npos) << d.problem;
    }
    return texture;
  }
  Float scalar(const std::string& text, Vec2 uv, const std::string& problem = "") {
    return parse(text, parse_scalar_texture, problem).at(uv);
  }
  test::TemporaryFolder folder_;
};

TEST_F(DataTextureFile, NumbersAndCheckerboards) {
  EXPECT_EQ(scalar("0.25", {0, 0}), Float(0.25));
  const std::string board = R"({"checkerboard": {"even": 0.2, "odd": 1, "repeat": [2, 1]}})";
  EXPECT_EQ(scalar(board, {Float(0.1), Float(0.5)}), Float(0.2));
  EXPECT_EQ(scalar(board, {Float(0.6), Float(0.5)}), Float(1));
  EXPECT_EQ(scalar(board, {Float(-0.1), Float(0.5)}), Float(1));
  scalar("1.5", {0, 0}, "[0, 1]");
  scalar(R"({"checkerboard": {"even": 0.2, "odd": 2}})", {0, 0}, "[0, 1]");
  scalar("{}", {0, 0}, "expected a number");
}

TEST_F(DataTextureFile, PixelsAreTakenAsStored) {
  // A PNG of the linear value that is stored as 188: a colour texture would say 0.5.
  write_png(folder_.path() / "half.png", one_pixel({"R", "G", "B"}, {0.5F, 0, 0}));
  EXPECT_NEAR(scalar(R"({"bitmap": "half.png"})", {Float(0.3), Float(0.3)}), 188 / 255.0, 1e-6);
  scalar(R"({"bitmap": "absent.png"})", {0, 0}, "there is no file");
}

TEST_F(DataTextureFile, AlphaIsTakenWhereThereIsOne) {
  write_exr(folder_.path() / "leaf.exr", one_pixel({"R", "G", "B", "A"}, {0.9F, 0.8F, 0.7F, 0.25F}), {});
  EXPECT_EQ(scalar(R"({"bitmap": "leaf.exr"})", {0, 0}), Float(0.25));
}

TEST_F(DataTextureFile, NormalsAreDecoded) {
  const auto normal = [&](float r, float g, float b) {
    write_exr(folder_.path() / "n.exr", one_pixel({"R", "G", "B"}, {r, g, b}), {});
    return parse("\"n.exr\"", parse_normal_texture).at({0, 0});
  };
  const Vec3 tilted = normal(0.8F, 0.5F, 0.9F);  // (0.6, 0, 0.8)
  EXPECT_NEAR(tilted.x, 0.6, 1e-6);
  EXPECT_NEAR(tilted.y, 0, 1e-6);
  EXPECT_NEAR(tilted.z, 0.8, 1e-6);
  EXPECT_EQ(normal(0.5F, 0.5F, 0.5F), (Vec3{0, 0, 1})) << "points nowhere";
  EXPECT_EQ(normal(0.5F, 0.9F, 0.2F), (Vec3{0, 0, 1})) << "points inwards";
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(normal(nan, nan, nan), (Vec3{0, 0, 1}));
  parse("\"absent.exr\"", parse_normal_texture, "there is no file");
}

TEST(DataTexture, RowsRunFromTheTopAndTexelsBlend) {
  Image image(1, 2, {"R"});
  image.data = {1, 0};
  const ScalarTexture texture{CachedImage(image)};
  EXPECT_EQ(texture.at({0, Float(0.75)}), 1);
  EXPECT_EQ(texture.at({0, Float(0.25)}), 0);
  EXPECT_EQ(texture.at({0, Float(0.5)}), Float(0.5));
}

}  // namespace
}  // namespace spectrace
