// SPDX-License-Identifier: Apache-2.0
#include "materials/packed_table.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "tests/support/chi_square.h"

namespace spectrace {
namespace {

constexpr PlaneShape kShape{.planes = 3, .rows = 5, .columns = 7};

template <typename T>
std::vector<T> noise(std::size_t size) {
  test::TestRandom random(7);
  std::vector<T> values(size);
  for (T& v : values) v = static_cast<T>(double(random.uniform()) * 65536);
  return values;
}

TEST(PackedTable, GivesBackWhatWentInWhateverItHolds) {
  const auto bytes = noise<std::uint8_t>(kShape.size());
  EXPECT_EQ(unpack_u8(pack("t", std::span<const std::uint8_t>(bytes), kShape), kShape), bytes);
  auto shorts = noise<std::uint16_t>(kShape.size());
  shorts[3] = 0;
  shorts[4] = 65535;  // the largest step there is
  EXPECT_EQ(unpack_u16(pack("t", std::span<const std::uint16_t>(shorts), kShape), kShape), shorts);
}

TEST(PackedTable, SmoothTablesBecomeSmall) {
  constexpr PlaneShape kLarge{.planes = 4, .rows = 64, .columns = 64};
  std::vector<std::uint16_t> ramp;
  for (std::size_t i = 0; i < kLarge.size(); ++i) {
    ramp.push_back(static_cast<std::uint16_t>(5 * (i % 64) + 3 * (i / 64 % 64)));
  }
  const Tensor packed = pack("t", std::span<const std::uint16_t>(ramp), kLarge);
  EXPECT_LT(packed.bytes.size(), ramp.size() * 2 / 50);  // a plane is predicted exactly
}

TEST(PackedTable, DamagedOrOfAnotherShapeIsNoTable) {
  const auto bytes = noise<std::uint8_t>(kShape.size());
  const Tensor whole = pack("t", std::span<const std::uint8_t>(bytes), kShape);
  EXPECT_FALSE(unpack_u8(whole, {.planes = 3, .rows = 5, .columns = 8}));
  EXPECT_FALSE(unpack_u16(whole, kShape));
  Tensor cut = whole;
  cut.bytes.resize(cut.bytes.size() / 2);
  EXPECT_FALSE(unpack_u8(cut, kShape));
  Tensor no_frame = whole;
  no_frame.bytes.assign(8, std::byte{0});
  EXPECT_FALSE(unpack_u8(no_frame, kShape));
}

TEST(PackedTable, NoFrameAsksForMoreThanItsBytesCanHold) {
  // A frame of RFC 8878 whose header promises 2^40 bytes in a single segment, and nothing behind it.
  Tensor frame{.name = "t", .type = TensorType::kU8, .shape = {14}, .bytes = {}};
  for (const int b : {0x28, 0xb5, 0x2f, 0xfd, 0xe0, 0, 0, 0, 0, 0, 1, 0, 0, 0})
    frame.bytes.push_back(std::byte(b));
  EXPECT_FALSE(unpack_u8(frame, {.planes = 1 << 14, .rows = 1 << 13, .columns = 1 << 13}));
  // The most that blocks can hold, a table of equal values, is still read.
  constexpr PlaneShape kEven{.planes = 16, .rows = 1024, .columns = 1024};
  const std::vector<std::uint8_t> zeros(kEven.size());
  EXPECT_EQ(unpack_u8(pack("t", std::span<const std::uint8_t>(zeros), kEven), kEven), zeros);
}

}  // namespace
}  // namespace spectrace
