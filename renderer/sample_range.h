// SPDX-License-Identifier: Apache-2.0
// Ranges of samples, and the binary tree in whose order they are summed. A sum of floating-point numbers
// depends on its order; by always adding the halves of aligned blocks, ranges rendered apart, on any number
// of machines and with any pauses, join to the same bits (ADR 0014).
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace spectrace {

/// Samples of a pixel that are traced together, and the leaves of the tree.
inline constexpr std::uint64_t kLeafSamples = 8;

/// Leaves [first, first + count) of the tree; a block: count a power of two and first a multiple of it.
struct LeafRange {
  std::uint64_t first = 0, count = 0;

  [[nodiscard]] std::uint64_t end() const { return first + count; }
  friend constexpr bool operator==(LeafRange, LeafRange) = default;
};

/// The largest block that begins at `first` and has at most `most` (> 0) leaves.
[[nodiscard]] constexpr LeafRange largest_block(std::uint64_t first, std::uint64_t most) {
  const std::uint64_t aligned = first == 0 ? most : std::uint64_t(1) << std::countr_zero(first);
  return {first, std::bit_floor(std::min(aligned, most))};
}
/// Are they the halves of one block?
[[nodiscard]] constexpr bool are_halves(LeafRange left, LeafRange right) {
  return left.count == right.count && left.end() == right.first && left.first % (2 * left.count) == 0;
}
/// The largest blocks that `leaves` consists of, from left to right: what joining halves as they come leaves.
[[nodiscard]] std::vector<LeafRange> blocks_of(LeafRange leaves);

/// Samples of a block, of `samples` that are in it, that make up its half B: its right half. Even and odd
/// samples would lie in opposite halves of every dimension of the Sobol' sequence, and so be two different
/// pictures; the halves of a block are as even as the block. Of a single leaf that is not full the later
/// half.
[[nodiscard]] constexpr std::uint64_t samples_in_half_b(LeafRange block, std::uint64_t samples) {
  if (block.count == 1) return samples / 2;
  const std::uint64_t left = block.count * kLeafSamples / 2;
  return samples > left ? samples - left : 0;
}

/// Sums the leaves of one block as they come, in the order of the tree. `T`: has +=, which adds the right
/// half to the left one.
template <typename T>
class BlockSum {
 public:
  /// `room`: what a leaf is copied from before there was one at its place.
  explicit BlockSum(T room) : room_(std::move(room)) {}

  void clear() { count_ = height_ = 0; }
  /// To be filled; what is there is left over from before. end_leaf() adds it.
  [[nodiscard]] T& begin_leaf() {
    if (height_ == stack_.size()) stack_.push_back(room_);
    return stack_[height_++];
  }
  void end_leaf() {
    // As many halves are now complete as the count has zeros at its end.
    for (std::uint64_t blocks = ++count_; blocks % 2 == 0; blocks /= 2) {
      --height_;
      stack_[height_ - 1] += stack_[height_];
    }
  }
  void add(const T& leaf) {
    begin_leaf() = leaf;
    end_leaf();
  }
  /// Of the 2^k leaves added.
  [[nodiscard]] const T& sum() const { return stack_.front(); }

 private:
  T room_;
  std::vector<T> stack_;     // sums of the blocks that wait for their right halves, the largest first
  std::size_t height_ = 0;   // of the stack; above it is room
  std::uint64_t count_ = 0;  // leaves
};

/// Samples [first, last) of each pixel; first a multiple of kLeafSamples.
struct SampleRange {
  std::uint64_t first = 0, last = 0;

  [[nodiscard]] std::uint64_t count() const { return last - first; }
  /// The leaves it touches; the last one may be incomplete.
  [[nodiscard]] LeafRange leaves() const {
    const std::uint64_t begin = first / kLeafSamples;
    return {begin, (last + kLeafSamples - 1) / kLeafSamples - begin};
  }
  friend constexpr bool operator==(SampleRange, SampleRange) = default;
};

}  // namespace spectrace
