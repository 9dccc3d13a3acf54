// SPDX-License-Identifier: Apache-2.0
// Building of a LightTree: ranges of leaves are parted where the surface area orientation heuristic is least.
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "core/base/error.h"
#include "core/math/math.h"
#include "renderer/light_tree.h"

namespace spectrace {

namespace {

using Leaf = LightTree::Leaf;

constexpr int kBuckets = 12;  // candidates for a border on each axis: as Conty Estevez and Kulla take

/// What a part of the tree costs: intensity, size, and how many ways its lights look, in the manner of Conty
/// Estevez and Kulla 2018, eq. 2. The size is that of the bounding sphere, which is what estimates know of.
double cost(const LightBounds& b) {
  return b.box.empty() ? 0 : (b.intensity() + b.facing * (1 - b.agreement())) * sqr(double(b.box.radius()));
}

Float coordinate(Vec3 v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

struct Range {
  std::size_t begin = 0, end = 0;
  [[nodiscard]] std::size_t size() const { return end - begin; }
};

/// Where leaves are parted: those in buckets up to `last` of `axis` go left.
struct Border {
  int axis = 0, last = 0;
  double cost = std::numeric_limits<double>::infinity();
};

/// Buckets of equal width along one axis of the box of all centres.
struct Buckets {
  int axis = 0;
  Float low = 0, extent = 0;

  Buckets(const Box& centers, int along)
      : axis(along), low(coordinate(centers.min, along)), extent(coordinate(centers.max, along) - low) {}
  [[nodiscard]] int index(const Leaf& leaf) const {
    const Float place = (coordinate(leaf.bounds.center(), axis) - low) / extent;
    return std::clamp(int(place * kBuckets), 0, kBuckets - 1);
  }
};

Border best_border(std::span<const Leaf> leaves, const Buckets& buckets, double longest) {
  std::array<LightBounds, kBuckets> parts{};
  for (const Leaf& leaf : leaves) {
    LightBounds& part = parts[std::size_t(buckets.index(leaf))];
    part = unite(part, leaf.bounds);
  }
  std::array<double, kBuckets> right{};
  LightBounds behind;
  for (int i = kBuckets - 1; i > 0; --i) {
    behind = unite(behind, parts[std::size_t(i)]);
    right[std::size_t(i)] = cost(behind);
  }
  // Ibid.: long boxes are cut across.
  const double regularizer = longest / double(buckets.extent);
  Border best{buckets.axis};
  LightBounds before;
  for (int i = 0; i + 1 < kBuckets; ++i) {
    before = unite(before, parts[std::size_t(i)]);
    const double both = regularizer * (cost(before) + right[std::size_t(i) + 1]);
    if (both < best.cost) best = {buckets.axis, i, both};
  }
  return best;
}

}  // namespace

class LightTree::Builder {
 public:
  Builder(LightTree& tree, std::vector<Leaf> leaves) : tree_(tree), leaves_(std::move(leaves)) {}

  void build() {
    LightBounds all;
    for (const Leaf& leaf : leaves_) all = unite(all, leaf.bounds);
    tree_.unit_ = all.intensity();  // far from the ends of what single precision holds
    add_node({0, leaves_.size()}, 0, 0);
  }

 private:
  struct Child {
    std::uint32_t index = 0;
    LightBounds bounds;
  };

  Child add_node(Range range, int depth, std::uint64_t trail) {
    SPECTRACE_CHECK(depth < kMaxDepth);
    const auto index = std::uint32_t(tree_.nodes_.size());
    tree_.nodes_.emplace_back();
    LightBounds all;
    const std::vector<Range> ranges = part(range, depth);
    for (std::size_t i = 0; i < ranges.size(); ++i) {
      const std::uint64_t way = trail | std::uint64_t(i) << (kTrailBits * depth);
      const Child child =
          ranges[i].size() == 1 ? add_leaf(ranges[i].begin, way) : add_node(ranges[i], depth + 1, way);
      set_child(tree_.nodes_[index], i, child);
      all = unite(all, child.bounds);
    }
    return {index, all};
  }

  Child add_leaf(std::size_t place, std::uint64_t trail) {
    const auto& [light, bounds] = leaves_[place];
    tree_.trails_[light] = trail;
    tree_.present_[light] = true;
    return {light | kLeafBit, bounds};
  }

  // A leaf is never opened: its half extents are those of a cube with its sphere's radius for a half
  // diagonal.
  static std::array<double, 3> half_extents(const Child& child) {
    const LightBounds& b = child.bounds;
    if ((child.index & kLeafBit) != 0) {
      const double half = b.radius / std::sqrt(3.0);
      return {half, half, half};
    }
    const Vec3 extent = b.box.max - b.box.min;
    return {0.5 * double(extent.x), 0.5 * double(extent.y), 0.5 * double(extent.z)};
  }

  void set_child(Node& node, std::size_t i, const Child& child) const {
    const LightBounds& b = child.bounds;
    const Vec3 center = b.center();
    node.x[i] = float(center.x);
    node.y[i] = float(center.y);
    node.z[i] = float(center.z);
    // Rounding of positions in and around it; its square must not vanish in single precision.
    constexpr double kRoundingSteps = 16, kLeast = 1e-18;
    const double rounding = std::max(kRoundingSteps * 0x1p-24 * (max_abs(center) + b.radius), kLeast);
    const std::array<double, 3> half = half_extents(child);
    node.half_x[i] = float(half[0] + rounding);
    node.half_y[i] = float(half[1] + rounding);
    node.half_z[i] = float(half[2] + rounding);
    const double facing = b.facing / tree_.unit_;
    node.around[i] = float(b.around / tree_.unit_);
    node.directed_x[i] = float(b.directed[0] / tree_.unit_);
    node.directed_y[i] = float(b.directed[1] / tree_.unit_);
    node.directed_z[i] = float(b.directed[2] / tree_.unit_);
    node.facing_squared[i] = float(sqr(facing));
    node.disagreement[i] = float(sqr(facing) * (1 - b.agreement()));
    node.child[i] = child.index;
  }

  /// Up to kWidth parts: the largest is parted further.
  std::vector<Range> part(Range range, int depth) {
    std::vector<Range> parts{range};
    while (parts.size() < std::size_t(kWidth)) {
      const auto largest = std::max_element(
          parts.begin(), parts.end(), [](const Range& a, const Range& b) { return a.size() < b.size(); });
      if (largest->size() < 2) break;
      const Range whole = *largest;
      const std::size_t border = find_border(whole, depth);
      *largest = {whole.begin, border};
      parts.insert(largest + 1, Range{border, whole.end});
    }
    return parts;
  }

  /// Reorders the leaves of `range`, of two or more, and returns where its second part begins.
  std::size_t find_border(Range range, int depth) {
    const std::size_t middle = range.begin + range.size() / 2;
    // Half of the levels are for the heuristic; the others hold 4^16 lights, however they lie.
    if (depth >= kMaxDepth / 2 || range.size() <= 2) return middle;
    const auto first = leaves_.begin() + std::ptrdiff_t(range.begin),
               last = leaves_.begin() + std::ptrdiff_t(range.end);
    Box centers;
    for (auto leaf = first; leaf != last; ++leaf) centers.add(leaf->bounds.center());
    const Vec3 extent = centers.max - centers.min;
    Border best;
    for (int axis = 0; axis < 3; ++axis) {
      if (!(coordinate(extent, axis) > 0)) continue;
      const Border border = best_border({first, last}, Buckets(centers, axis), double(max_abs(extent)));
      if (border.cost < best.cost) best = border;
    }
    if (!std::isfinite(best.cost)) return middle;
    // Stable: the same tree from every standard library.
    const Buckets buckets(centers, best.axis);
    const auto border = std::stable_partition(
        first, last, [&](const Leaf& leaf) { return buckets.index(leaf) <= best.last; });
    return border == first || border == last ? middle : std::size_t(border - leaves_.begin());
  }

  LightTree& tree_;
  std::vector<Leaf> leaves_;
};

LightTree::LightTree(std::vector<Leaf> leaves, std::uint32_t light_count)
    : trails_(light_count), present_(light_count) {
  SPECTRACE_CHECK(light_count < kLeafBit);
  if (!leaves.empty()) {
    Builder(*this, std::move(leaves)).build();
  }
}

}  // namespace spectrace
