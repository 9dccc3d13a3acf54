// SPDX-License-Identifier: Apache-2.0
// Choice of one among many lights in logarithmic time, by an estimate of what each sends to the point to be
// lit: a tree of light bounds, as Conty Estevez and Kulla 2018, "Importance Sampling of Many Lights with
// Adaptive Tree Splitting", four wide: one pass through SIMD registers weighs all children of a node. Where
// they split near clusters into several samples, one light is chosen from a cut through the tree that is
// finer near the receiver (ADR 0011).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "renderer/light_bounds.h"

namespace spectrace {

/// What light falls on.
struct Receiver {
  Vec3 position;
  Vec3 normal;  ///< unit; only light from its side counts. Zero: from both sides
};

/// Immutable. The same tree, choices and probabilities wherever single precision rounds alike.
class LightTree {
 public:
  static constexpr int kWidth = 4;  ///< children of a node

  struct Choice {
    std::uint32_t light = 0;
    Float probability = 0;
  };
  /// One light with intensity.
  struct Leaf {
    std::uint32_t light = 0;
    LightBounds bounds;
  };
  /// Parts of the tree that hold all lights which may light a receiver, with estimates of what they send.
  class Cut;

  LightTree() = default;
  /// `leaves` with positive intensities, in any order; `light_count` above all their numbers.
  LightTree(std::vector<Leaf> leaves, std::uint32_t light_count);

  [[nodiscard]] bool empty() const { return nodes_.empty(); }
  /// What all intensities were divided by: estimates are irradiances / unit().
  [[nodiscard]] double unit() const { return unit_; }

  /// `u` in [0, 1); `cut` of this receiver, its sum above 0.
  [[nodiscard]] Choice choose(const Cut& cut, const Receiver& receiver, Float u) const;
  /// Of choose() returning `light`: the same bits. 0 for lights that are not in the tree.
  [[nodiscard]] Float probability(const Cut& cut, const Receiver& receiver, std::uint32_t light) const;

 private:
  using Lanes = std::array<float, kWidth>;
  /// Children side by side, so that all are weighed at once. Lanes without a child have no intensity.
  struct alignas(16) Node {
    Lanes x{}, y{}, z{};                             // centres of boxes
    Lanes half_x{1, 1, 1, 1}, half_y{}, half_z{};    // and half their extents: not all 0
    Lanes around{};                                  // of LightBounds, in unit()
    Lanes directed_x{}, directed_y{}, directed_z{};  // likewise
    Lanes facing_squared{}, disagreement{};          // facing², facing² (1 - agreement)
    std::array<std::uint32_t, kWidth> child{};       // node, or kLeafBit | light
  };
  struct Weights {
    Lanes child{};  // estimates of irradiance
    Lanes near{};   // not 0: the receiver is so near that parts of the child may send far more than its mean
    float sum = 0;
  };
  class Builder;
  static constexpr std::uint32_t kLeafBit = std::uint32_t(1) << 31;
  /// How to reach a light from the root: two bits a level, the root's lowest.
  static constexpr int kTrailBits = 2, kMaxDepth = 64 / kTrailBits;

  [[nodiscard]] static Weights weigh(const Node& node, const Receiver& receiver);

  std::vector<Node> nodes_;
  std::vector<std::uint64_t> trails_;  // by light
  std::vector<bool> present_;          // by light
  double unit_ = 1;
};

class LightTree::Cut {
 public:
  Cut(const LightTree& tree, const Receiver& receiver);
  [[nodiscard]] float sum() const { return sum_; }

 private:
  friend class LightTree;
  /// Nodes replaced by their children, at most: as many as the four levels about a place where four boxes
  /// meet ask for, and some to spare (ADR 0011).
  static constexpr int kMaxOpened = 24;
  struct Part {
    float weight = 0;
    std::uint32_t child = 0;  // as in a node
    std::uint64_t trail = 0;
    int depth = 0;
    bool opens = false;  // near, and no leaf
  };
  void add_children(const LightTree& tree, const Receiver& receiver, std::uint32_t node, std::uint64_t trail,
                    int depth);
  [[nodiscard]] int count_opening(int begin) const;

  // Written up to size_ only: clearing it all would cost more than to choose among few lights.
  std::array<Part, std::size_t(kWidth) * (kMaxOpened + 1)> parts_;
  int size_ = 0;
  float sum_ = 0;
};

}  // namespace spectrace
