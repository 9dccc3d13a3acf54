// SPDX-License-Identifier: Apache-2.0
#include "renderer/sample_range.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>

namespace spectrace::test {
namespace {

TEST(SampleRange, BlocksCoverARangeAndNoTwoAreHalvesOfOne) {
  for (std::uint64_t first = 0; first < 40; ++first) {
    for (std::uint64_t count = 1; count < 70; ++count) {
      const std::vector<LeafRange> blocks = blocks_of({first, count});
      std::uint64_t at = first;
      for (std::size_t i = 0; i < blocks.size(); ++i) {
        EXPECT_EQ(blocks[i].first, at);
        EXPECT_TRUE(std::has_single_bit(blocks[i].count));
        EXPECT_EQ(blocks[i].first % blocks[i].count, 0U);
        EXPECT_FALSE(i > 0 && are_halves(blocks[i - 1], blocks[i]));
        at = blocks[i].end();
      }
      EXPECT_EQ(at, first + count);
    }
  }
}

TEST(SampleRange, PowersOfTwoFromTheStartAreOneBlock) {
  for (std::uint64_t count : {1, 2, 4, 64, 1 << 20}) {
    EXPECT_EQ(blocks_of({0, count}), (std::vector<LeafRange>{{0, count}}));
  }
}

TEST(SampleRange, LeavesAreWhatSamplesTouch) {
  EXPECT_EQ((SampleRange{0, 8}.leaves()), (LeafRange{0, 1}));
  EXPECT_EQ((SampleRange{0, 9}.leaves()), (LeafRange{0, 2}));
  EXPECT_EQ((SampleRange{16, 100}.leaves()), (LeafRange{2, 11}));
}

struct Number {
  double x = 0;
  Number& operator+=(const Number& o) {
    x += o.x;
    return *this;
  }
};

TEST(BlockSum, AddsHalvesOfHalves) {
  // Magnitudes apart, so that every other order of adding has other bits.
  const std::array<double, 8> v{1e16, 1, -1e16, 3, 0.1, 1e8, -1e8, 0.3};
  BlockSum<Number> sum{Number{}};
  for (int round = 0; round < 2; ++round) {  // it can be used again
    sum.clear();
    for (const double x : v) {
      Number leaf{x};
      sum.add(leaf);
    }
    EXPECT_EQ(sum.sum().x, ((v[0] + v[1]) + (v[2] + v[3])) + ((v[4] + v[5]) + (v[6] + v[7])));
  }
}

}  // namespace
}  // namespace spectrace::test
