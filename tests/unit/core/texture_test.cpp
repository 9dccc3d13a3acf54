// SPDX-License-Identifier: Apache-2.0
#include "core/image/texture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/spectra/color.h"
#include "tests/support/chi_square.h"
#include "tests/support/temporary_folder.h"

namespace spectrace {
namespace {

SampledWavelengths wavelengths_at(Float nm) {
  std::array<Float, kLanes> all, pdf;
  all.fill(nm);
  pdf.fill(1);
  return {all, pdf};
}

/// Colour of a place under D65.
Rgb color_at(const Texture& texture, Vec2 uv) {
  std::vector<Float> nm, values;
  for (int i = 360; i <= 830; ++i) {
    nm.push_back(Float(i));
    values.push_back(texture.sample(wavelengths_at(Float(i)), uv)[0]);
  }
  return xyz_to_rgb(reflectance_to_xyz(TabulatedSpectrum(nm, values)));
}

Image random_image(int width, int height) {
  Image image(width, height, {"R", "G", "B"});
  test::TestRandom random(5);
  for (float& x : image.data) x = static_cast<float>(random.uniform());
  return image;
}

TEST(Texture, SpectraAreTheSameEverywhere) {
  const Texture t{Spectrum::constant(Float(0.4))};
  EXPECT_FALSE(t.is_textured());
  EXPECT_EQ(t.sample(wavelengths_at(500), {7, -3})[0], 0.4f);
}

TEST(Texture, CheckerboardAlternatesAlsoBelowZero) {
  const Texture t{Checkerboard{Spectrum::constant(1), Spectrum::constant(0), 2, 4}};
  EXPECT_TRUE(t.is_textured());
  const auto at = [&](Float u, Float v) { return t.sample(wavelengths_at(500), {u, v})[0]; };
  EXPECT_EQ(at(0.1f, 0.1f), 1);
  EXPECT_EQ(at(0.6f, 0.1f), 0);
  EXPECT_EQ(at(0.1f, 0.3f), 0);
  EXPECT_EQ(at(0.6f, 0.3f), 1);
  EXPECT_EQ(at(-0.1f, 0.1f), 0) << "no doubled cell around 0";
  EXPECT_EQ(at(-0.1f, -0.1f), 1);
}

TEST(Texture, PalettesHoldEverySpectrumThatTheSurfaceShows) {
  const Texture plain{Spectrum::constant(Float(0.4))};
  EXPECT_EQ(plain.palette_size(), 1u);
  EXPECT_EQ(plain.palette_index({7, -3}), 0u);
  EXPECT_EQ(Texture(BitmapTexture(random_image(2, 2))).palette_size(), 0u);
  for (const Vec2 repeat : {Vec2{2, 4}, Vec2{Float(0.1), 1}, Vec2{1000, Float(1e-3)}}) {
    const Texture board{Checkerboard{Spectrum::constant(1), Spectrum::constant(0), repeat.x, repeat.y}};
    ASSERT_EQ(board.palette_size(), 2u);
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_EQ(board.palette_index(board.palette_uv(i)), i);
      EXPECT_EQ(board.sample(wavelengths_at(500), board.palette_uv(i))[0], i == 0 ? 1 : 0);
    }
  }
}

TEST(Texture, BitmapHasTheBottomRowAtVZero) {
  Image image(1, 4, {"R", "G", "B"});
  for (int y = 0; y < 4; ++y) image.at(0, y, 1) = float(y) / 4;
  const BitmapTexture t(image);
  EXPECT_NEAR(t.rgb_at({0.5f, 0.125f})[1], 0.75, 1e-6);  // bottom texel's centre
  EXPECT_NEAR(t.rgb_at({0.5f, 0.875f})[1], 0, 1e-6);     // top texel's centre
  EXPECT_NEAR(t.rgb_at({0.5f, 0.25f})[1], 0.625, 1e-6);  // half way between two
}

TEST(Texture, BitmapRepeats) {
  const BitmapTexture t(random_image(5, 3));
  for (const Vec2 uv : {Vec2{0.03f, 0.97f}, Vec2{0.5f, 0.5f}, Vec2{0.99f, 0.01f}}) {
    for (const Float shift : {Float(1), Float(-1), Float(8)}) {
      for (std::size_t c = 0; c < 3; ++c) {
        EXPECT_NEAR(t.rgb_at(uv)[c], t.rgb_at({uv.x + shift, uv.y - shift})[c], 1e-5);  // the shift rounds uv
      }
    }
  }
  const Rgb left = t.rgb_at({1e-6f, 0.5f}), right = t.rgb_at({1 - 1e-6f, 0.5f});
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(left[c], right[c], 2e-5) << "no seam";
}

TEST(Texture, BitmapIsBilinear) {
  const Image image = random_image(4, 4);
  const BitmapTexture t(image);
  for (std::size_t c = 0; c < 3; ++c) {
    const double expected =
        0.25 * (image.at(1, 1, c) + image.at(2, 1, c) + image.at(1, 2, c) + image.at(2, 2, c));
    EXPECT_NEAR(t.rgb_at({0.5f, 0.5f})[c], expected, 1e-6);
  }
}

TEST(Texture, UnusableTexelsAndCoordinatesDoNoHarm) {
  Image image(2, 1, {"R", "G", "B"});
  image.data = {-1, std::numeric_limits<float>::quiet_NaN(), 7, 0.5f, 0.5f, 0.5f};
  const BitmapTexture t(image);
  EXPECT_EQ(t.rgb_at({0.25f, 0.5f}), (Rgb{0, 0, 1}));
  const Float nan = std::numeric_limits<Float>::quiet_NaN(), inf = std::numeric_limits<Float>::infinity();
  for (const Vec2 uv : {Vec2{nan, 0}, Vec2{0, inf}, Vec2{1e30f, -1e30f}, Vec2{-1e-30f, 1}}) {
    for (const double x : t.rgb_at(uv)) EXPECT_TRUE(x >= 0 && x <= 1);
  }
}

TEST(Texture, AverageColourIsPreserved) {
  const Image image = random_image(8, 6);
  const Texture t{BitmapTexture(image)};
  Rgb from_image{}, from_spectra{};
  for (int y = 0; y < 6; ++y) {
    for (int x = 0; x < 8; ++x) {
      const Rgb seen = color_at(t, {Float(x + 0.5) / 8, Float(y + 0.5) / 6});
      for (std::size_t c = 0; c < 3; ++c) {
        from_image[c] += double(image.at(x, y, c)) / 48;
        from_spectra[c] += seen[c] / 48;
      }
    }
  }
  // The bound of one texel's uplift; errors of different texels partly cancel.
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(from_spectra[c], from_image[c], 1e-3);
}

struct Parsed {
  Texture texture;
  std::vector<std::string> problems;
};
Parsed parse(const std::string& json, const std::string& file = "t.json") {
  JsonDocument document = JsonDocument::parse(json, file);
  Parsed p;
  p.texture = parse_texture(document.root());
  for (const Diagnostic& d : document.diagnostics()) p.problems.push_back(d.where + ": " + d.problem);
  return p;
}

TEST(TextureJson, ReadsEveryForm) {
  const test::TemporaryFolder folder;
  write_exr(folder.path() / "a.exr", random_image(4, 4), {});
  EXPECT_FALSE(parse("0.5").texture.is_textured());
  EXPECT_FALSE(parse(R"({"rgb": [1, 0, 0]})").texture.is_textured());
  const Parsed board =
      parse(R"({"checkerboard": {"even": 0.1, "odd": {"rgb": [1, 1, 1]}, "repeat": [10, 10]}})");
  EXPECT_TRUE(board.problems.empty());
  EXPECT_EQ(board.texture.sample(wavelengths_at(500), {0.05f, 0.05f})[0], 0.1f);
  EXPECT_NEAR(board.texture.sample(wavelengths_at(500), {0.15f, 0.05f})[0], 1, 1e-6);
  const Parsed bitmap = parse(R"({"bitmap": "a.exr"})", (folder.path() / "t.json").string());
  EXPECT_TRUE(bitmap.problems.empty());
  EXPECT_TRUE(bitmap.texture.is_textured());
}

TEST(TextureJson, NamesMistakesAtTheirPlace) {
  const struct {
    const char* text;
    const char* problem;
  } cases[] = {
      {R"({"checkerboard": {"even": 0.1}})", "1:18: /checkerboard: missing required key \"odd\""},
      {R"({"checkerboard": {"even": 0.1, "odd": 2}})",
       "1:39: /checkerboard/odd: expected a number in [0, 1], got 2"},
      {R"({"checkerboard": {"even": 0, "odd": 1, "repeat": [0, 1]}})",
       "1:51: /checkerboard/repeat/0: expected"},
      {R"({"checkerboard": {"even": 0, "odd": 1, "repeats": 2}})",
       "1:40: /checkerboard/repeats: unknown key"},
      {R"({"bitmap": "nowhere.png"})", "1:12: /bitmap: nowhere.png"},
      {R"({"bitmap": 3})", "1:12: /bitmap: expected a file name"},
      {R"({"bitmp": "a.png"})", "1:2: /bitmp: unknown key"},
  };
  for (const auto& c : cases) {
    const Parsed p = parse(c.text);
    ASSERT_FALSE(p.problems.empty()) << c.text;
    EXPECT_EQ(p.problems[0].substr(0, std::string(c.problem).size()), c.problem) << c.text;
  }
}

}  // namespace
}  // namespace spectrace
