// SPDX-License-Identifier: Apache-2.0
// Sums that do not depend on who made their parts; identities of metrics.
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/image/metrics.h"
#include "renderer/sample_range.h"

namespace spectrace::test {
namespace {

/// The sum of the leaves of a block, by halves: what BlockSum and merging must give, to the bit.
float tree_sum(const std::vector<float>& leaves, LeafRange block) {
  if (block.count == 1) return leaves[block.first];
  const std::uint64_t half = block.count / 2;
  return tree_sum(leaves, {block.first, half}) + tree_sum(leaves, {block.first + half, half});
}

RC_GTEST_PROP(SampleTree, BlocksCoverTheirRangeInOrder, ()) {
  const LeafRange range{*rc::gen::inRange<std::uint64_t>(0, 1U << 20),
                        *rc::gen::inRange<std::uint64_t>(1, 1U << 20)};
  std::uint64_t at = range.first;
  for (const LeafRange block : blocks_of(range)) {
    RC_ASSERT(block.first == at);
    RC_ASSERT(std::has_single_bit(block.count));
    RC_ASSERT(block.first % block.count == 0U);
    at = block.end();
  }
  RC_ASSERT(at == range.end());
}

RC_GTEST_PROP(SampleTree, JoiningPartsGivesTheBlocksOfTheWhole, ()) {
  const auto cuts = *rc::gen::container<std::vector<std::uint64_t>>(rc::gen::inRange<std::uint64_t>(1, 40));
  RC_PRE(!cuts.empty());
  std::vector<LeafRange> joined;
  std::uint64_t at = 0;
  for (const std::uint64_t count : cuts) {
    for (const LeafRange block : blocks_of({at, count})) {
      joined.push_back(block);
      while (joined.size() > 1 && are_halves(joined[joined.size() - 2], joined.back())) {
        joined.pop_back();
        joined.back().count *= 2;
      }
    }
    at += count;
  }
  RC_ASSERT(joined == blocks_of({0, at}));
}

RC_GTEST_PROP(SampleTree, LeavesAreSummedByHalves, ()) {
  const std::size_t count = std::size_t(1) << *rc::gen::inRange(0, 8);
  const auto leaves = *rc::gen::container<std::vector<float>>(
      count, rc::gen::map(rc::gen::inRange(-100000, 100000), [](int i) { return float(i) * 1e-3F; }));
  BlockSum<float> sum(0.0F);
  for (float leaf : leaves) sum.add(leaf);
  RC_ASSERT(sum.sum() == tree_sum(leaves, {0, count}));
}

Image random_image() {
  Image image(12, 12, {"R", "G", "B"});
  image.data = *rc::gen::container<std::vector<float>>(
      image.data.size(), rc::gen::map(rc::gen::inRange(0, 4096), [](int i) { return float(i) / 1024; }));
  return image;
}

RC_GTEST_PROP(ImageMetrics, OfAnImageAndItselfAreThoseOfEquality, ()) {
  const Image image = random_image();
  const Metrics m = compare_images(image, image);
  RC_ASSERT(m.mse == 0 && m.mae == 0 && m.rel_mse == 0 && m.mape == 0 && m.max_abs == 0);
  RC_ASSERT(std::isinf(m.psnr_db));
  RC_ASSERT(std::abs(m.ssim - 1) <= 1e-12);
}

RC_GTEST_PROP(ImageMetrics, FollowTheScaleOfBothImages, ()) {
  const Image a = random_image(), b = random_image();
  Image a4 = a, b4 = b;
  for (float& x : a4.data) x *= 4;
  for (float& x : b4.data) x *= 4;
  MetricOptions options, options4;
  options.data_range = 4;
  options4.data_range = 16;
  options4.epsilon = 16 * options.epsilon;
  options4.mape_floor = 4 * options.mape_floor;
  const Metrics m = compare_images(a, b, options), m4 = compare_images(a4, b4, options4);
  const auto near = [](double x, double y) {
    return std::abs(x - y) <= 1e-12 * std::max(std::abs(x), std::abs(y));
  };
  RC_PRE(m.mse > 0);
  RC_ASSERT(near(m4.mse, 16 * m.mse));
  RC_ASSERT(near(m4.rel_mse, m.rel_mse));
  RC_ASSERT(near(m4.mape, m.mape));
  RC_ASSERT(near(m4.psnr_db, m.psnr_db));
  RC_ASSERT(std::abs(m4.ssim - m.ssim) <= 1e-9);
  const Metrics swapped = compare_images(b, a, options);
  RC_ASSERT(near(swapped.mse, m.mse));
  RC_ASSERT(std::abs(swapped.ssim - m.ssim) <= 1e-9);
}

}  // namespace
}  // namespace spectrace::test
