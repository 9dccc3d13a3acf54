// SPDX-License-Identifier: Apache-2.0
#include "materials/tensor_file.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "core/base/error.h"

namespace spectrace {
namespace {

std::vector<std::byte> bytes_of(std::string_view text) {
  const auto raw = std::as_bytes(std::span(text));
  return {raw.begin(), raw.end()};
}

TensorFile example() {
  TensorFile file;
  file.add(Tensor::from_text("description", "five"));
  file.add(Tensor::from_floats("grid", {2, 3}, std::array{1.f, 2.f, 3.f, 4.f, 5.f, 6.f}));
  file.add(Tensor::from_floats("last", {1}, std::array{7.f}));
  return file;
}

// Where example() keeps things: 12 + 2 + 4 bytes of head, then entries of 2 + name + 2 + 1 + 8 + 8 per
// dimension.
constexpr std::size_t kFirstEntry = 18, kSecondEntry = kFirstEntry + 2 + 11 + 11 + 8;
constexpr std::size_t kGridType = kSecondEntry + 2 + 4 + 2, kGridOffset = kGridType + 1,
                      kGridShape = kGridOffset + 8;

template <typename T>
void put(std::vector<std::byte>& bytes, std::size_t at, T value) {
  std::memcpy(bytes.data() + at, &value, sizeof(T));
}

std::string message_of(const std::vector<std::byte>& bytes) {
  try {
    (void)TensorFile::parse(bytes, "a.bsdf");
  } catch (const InputError& e) {
    EXPECT_EQ(e.diagnostics().size(), 1u);
    return e.diagnostics()[0].text();
  }
  return "(no error)";
}

#define EXPECT_MENTIONS(text, part) EXPECT_NE((text).find(part), std::string::npos) << (text)

TEST(TensorFile, ParseInvertsSerialize) {
  const std::vector<std::byte> bytes = example().serialize();
  const TensorFile file = TensorFile::parse(bytes, "a.bsdf");
  ASSERT_EQ(file.tensors().size(), 3u);
  EXPECT_EQ(file.file_name(), "a.bsdf");
  const Tensor& grid = file.tensors()[1];
  EXPECT_EQ(grid.name, "grid");
  EXPECT_EQ(grid.shape, (std::vector<std::size_t>{2, 3}));
  EXPECT_EQ(grid.shape_text(), "[2,3]");
  EXPECT_EQ(grid.floats(), (std::vector<float>{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(file.find("last")->floats(), std::vector<float>{7});
  EXPECT_EQ(file.find("absent"), nullptr);
  EXPECT_EQ(file.serialize(), bytes);
}

TEST(TensorFile, EmptyTextKeepsItsField) {
  TensorFile file;
  file.add(Tensor::from_text("description", ""));
  const TensorFile back = TensorFile::parse(file.serialize(), "a.bsdf");
  ASSERT_NE(back.find("description"), nullptr);
  EXPECT_TRUE(back.find("description")->bytes.empty());
}

TEST(TensorFile, ConvertsHalfAndDouble) {
  const std::array<std::uint16_t, 6> halves{0x3c00, 0xc000, 0x0001, 0x7c00, 0x7e00, 0x3555};
  Tensor half{.name = "h", .type = TensorType::kF16, .shape = {6}, .bytes = {}};
  const auto raw = std::as_bytes(std::span(halves));
  half.bytes.assign(raw.begin(), raw.end());
  const std::vector<float> values = half.floats();
  EXPECT_EQ(values[0], 1);
  EXPECT_EQ(values[1], -2);
  EXPECT_EQ(values[2], std::ldexp(1.f, -24));  // the least subnormal
  EXPECT_EQ(values[3], std::numeric_limits<float>::infinity());
  EXPECT_TRUE(std::isnan(values[4]));
  EXPECT_EQ(values[5], 0.333251953125f);

  Tensor wide{.name = "d", .type = TensorType::kF64, .shape = {1}, .bytes = {}};
  const double third = 1.0 / 3;
  wide.bytes.resize(sizeof third);
  std::memcpy(wide.bytes.data(), &third, sizeof third);
  EXPECT_EQ(wide.floats(), std::vector<float>{1.f / 3});
}

TEST(TensorFile, TellsOtherProgramsFilesByName) {
  EXPECT_MENTIONS(
      message_of(bytes_of("#Data\nSource  Measured\nSymmetry  PlaneSymmetrical\nSpectralContent  XYZ\n")),
      "Zemax");
  EXPECT_MENTIONS(message_of(bytes_of("# LightTools BSDF\nAOI 0\n")), "LightTools");
  EXPECT_MENTIONS(message_of(bytes_of("#?RADIANCE\nFORMAT=BSDF_RBFmesh\n\n")), "Radiance");
  EXPECT_MENTIONS(message_of(bytes_of("\xef\xbb\xbf<?xml version=\"1.0\"?>\n<WindowElement>")), "XML");
  EXPECT_MENTIONS(message_of(bytes_of("PK\x03\x04 anything else")), "PK\\x03");
  EXPECT_MENTIONS(message_of({}), "empty");
  EXPECT_MENTIONS(message_of(bytes_of("tensor_f")), "truncated");
  EXPECT_MENTIONS(message_of({}), "a.bsdf:byte 0");
}

TEST(TensorFile, NamesByteAndFieldOfAFault) {
  const std::vector<std::byte> good = example().serialize();
  auto bad = good;
  put<std::uint8_t>(bad, 12, 2);
  EXPECT_MENTIONS(message_of(bad), "byte 12: tensor file version 2.0");

  bad = good;
  put<std::uint8_t>(bad, kGridType, 12);
  EXPECT_MENTIONS(message_of(bad), "byte " + std::to_string(kGridType) + ": field \"grid\": element type 12");

  bad = good;
  put<std::uint64_t>(bad, kGridOffset, good.size() - 23);
  EXPECT_MENTIONS(message_of(bad), "byte " + std::to_string(kGridOffset) + ": field \"grid\": data at byte");
  put<std::uint64_t>(bad, kGridOffset, std::numeric_limits<std::uint64_t>::max() - 3);
  EXPECT_MENTIONS(message_of(bad), "beyond the end");

  bad = good;
  put<std::uint8_t>(bad, kFirstEntry + 4, 0xe9);
  EXPECT_MENTIONS(message_of(bad), "byte 18: field name \"de\\xe9cription\"");

  bad = good;
  put<std::uint16_t>(bad, kGridType - 2, 33);
  EXPECT_MENTIONS(message_of(bad), "33 dimensions");
}

TEST(TensorFile, RefusesShapesThatOverflow) {
  auto bad = example().serialize();
  put<std::uint64_t>(bad, kGridShape, std::uint64_t(1) << 62);
  put<std::uint64_t>(bad, kGridShape + 8, 8);  // 2^65 elements wrap to 2
  EXPECT_MENTIONS(message_of(bad), "larger than the file");
  put<std::uint64_t>(bad, kGridShape, std::uint64_t(1) << 61);
  put<std::uint64_t>(bad, kGridShape + 8, 2);  // 2^62 elements, whose bytes wrap to 0
  EXPECT_MENTIONS(message_of(bad), "larger than the file");
}

TEST(TensorFile, RefusesSharedBytes) {
  const std::vector<std::byte> good = example().serialize();
  const std::uint64_t last = TensorFile::parse(good, "").find("last")->offset;
  auto bad = good;
  put<std::uint64_t>(bad, kGridOffset, last - 23);
  EXPECT_MENTIONS(message_of(bad), "overlap the field \"grid\"");
  put<std::uint64_t>(bad, kGridOffset, 40);
  EXPECT_MENTIONS(message_of(bad), "overlap the header");
}

TEST(TensorFile, RefusesBytesThatBelongToNoField) {
  const std::vector<std::byte> good = example().serialize();
  const TensorFile file = TensorFile::parse(good, "");
  const std::uint64_t grid = file.find("grid")->offset, last = file.find("last")->offset;
  auto bad = good;
  bad[grid - 1] = std::byte(1);  // behind the four letters of the first field
  EXPECT_MENTIONS(message_of(bad), "byte " + std::to_string(grid - 1) + ": belongs to no field");
  bad = good;
  put<std::uint64_t>(bad, kGridShape, 1);  // half of the grid
  EXPECT_MENTIONS(message_of(bad), "byte " + std::to_string(grid + 14) + ": belongs to no field");
  bad = good;
  bad.push_back(std::byte(1));
  EXPECT_MENTIONS(message_of(bad), "byte " + std::to_string(last + 4) + ": belongs to no field");
  bad.back() = std::byte(0);
  EXPECT_EQ(message_of(bad), "(no error)");
}

TEST(TensorFile, RefusesAFieldThatLiesElsewhereThanTheOthersSay) {
  TensorFile file;
  for (const char* name : {"a", "b", "c", "d"})
    file.add(Tensor::from_floats(name, {3}, std::array{0.f, 0.f, 0.f}));
  const std::vector<std::byte> good = file.serialize();
  const TensorFile whole = TensorFile::parse(good, "");
  constexpr std::size_t kEntry = 2 + 1 + 2 + 1 + 8 + 8, kThirdOffset = kFirstEntry + 2 * kEntry + 6;
  const std::uint64_t third = whole.tensors()[2].offset;
  auto bad = good;
  put<std::uint64_t>(bad, kThirdOffset, third + 4);  // only zeros move
  EXPECT_MENTIONS(message_of(bad), "field \"c\": its data do not lie where those of the other fields end");

  // Other writers may pack, or align more.
  for (const std::uint64_t step : {12, 64}) {
    bad.assign(good.begin(), good.begin() + std::ptrdiff_t(whole.tensors()[0].offset));
    bad.resize(1024);
    for (std::size_t i = 0; i < 4; ++i) put<std::uint64_t>(bad, kFirstEntry + i * kEntry + 6, 128 + i * step);
    EXPECT_EQ(message_of(bad), "(no error)") << step;
  }
}

TEST(TensorFile, RefusesDuplicateNamesAndTooManyFields) {
  TensorFile file;
  file.add(Tensor::from_text("aa", "x"));
  file.add(Tensor::from_text("ab", "y"));
  auto bad = file.serialize();
  put<std::uint8_t>(bad, kFirstEntry + 2 + 2 + 11 + 8 + 2 + 1, 'a');
  EXPECT_MENTIONS(message_of(bad), "a second field of this name");
  put<std::uint32_t>(bad, 14, 0xffffffff);
  EXPECT_MENTIONS(message_of(bad), "4294967295 fields");
}

TEST(TensorFile, RequireNamesTypeAndShape) {
  const TensorFile file = TensorFile::parse(example().serialize(), "a.bsdf");
  const auto message = [&](std::string_view name, TensorType type,
                           std::vector<std::size_t> shape) -> std::string {
    try {
      (void)file.require(name, std::array{type}, shape);
    } catch (const InputError& e) {
      return e.diagnostics()[0].text();
    }
    return "";
  };
  EXPECT_EQ(message("grid", TensorType::kF32, {0, 3}), "");
  EXPECT_MENTIONS(message("grid", TensorType::kF32, {2, 4}), "shape [2,3], expected [2,4]");
  EXPECT_MENTIONS(message("grid", TensorType::kF32, {0}), "shape [2,3], expected [any]");
  EXPECT_MENTIONS(message("grid", TensorType::kU8, {2, 3}), "element type f32, expected u8");
  EXPECT_MENTIONS(message("ndf", TensorType::kF32, {0}),
                  "field \"ndf\": missing; the file holds description, grid, last");
}

TEST(TensorFile, EveryTruncationIsAnError) {
  const std::vector<std::byte> good = example().serialize();
  for (std::size_t size = 0; size < good.size(); ++size) {
    EXPECT_THROW((void)TensorFile::parse(std::span(good).first(size), "a.bsdf"), InputError) << size;
  }
  const std::vector<std::byte> one_short(good.begin(), good.begin() + kFirstEntry + 1);
  EXPECT_MENTIONS(message_of(one_short), "byte 18: truncated: a field's name length needs 2 bytes");
}

TEST(TensorFile, NoCorruptionOfTheHeaderCrashes) {
  const std::vector<std::byte> good = example().serialize();
  const std::size_t header = TensorFile::parse(good, "").tensors().front().offset;
  std::mt19937 random(7);
  for (int trial = 0; trial < 20000; ++trial) {
    auto bytes = good;
    const int flips = 1 + static_cast<int>(random() % 4);
    for (int i = 0; i < flips; ++i) bytes[random() % header] = std::byte(random() & 0xff);
    try {
      const TensorFile file = TensorFile::parse(bytes, "a.bsdf");
      std::size_t held = 0;
      for (const Tensor& t : file.tensors()) held += t.bytes.size();
      EXPECT_LE(held, bytes.size());
    } catch (const InputError&) {
    }
  }
}

}  // namespace
}  // namespace spectrace
