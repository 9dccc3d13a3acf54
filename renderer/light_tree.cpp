// SPDX-License-Identifier: Apache-2.0
#include "renderer/light_tree.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "core/math/math.h"

namespace spectrace {

namespace {

/// One number for each child: a SIMD register. Written with the compiler's vectors, since GCC 12 makes none
/// of a loop with selects. Single precision whatever Float is: estimates need no more.
using Floats = float __attribute__((vector_size(16)));
static_assert(sizeof(Floats) == LightTree::kWidth * sizeof(float));

inline Floats floats(const std::array<float, LightTree::kWidth>& lanes) {
  Floats f;
  std::memcpy(&f, lanes.data(), sizeof(f));
  return f;
}
inline Floats floats(Float x) { return Floats{} + float(x); }
inline void store(Floats f, std::array<float, LightTree::kWidth>& lanes) {
  std::memcpy(lanes.data(), &f, sizeof(f));
}
/// Of x >= 0.
inline Floats root(Floats x) {
  return Floats{std::sqrt(x[0]), std::sqrt(x[1]), std::sqrt(x[2]), std::sqrt(x[3])};
}

/// An estimate of the mean of max(X, 0) where X has this mean and spreads by `spread` (squared) about it:
/// exact where there is no spread, and for the cosine over a whole sphere of directions (mean 0, spread 1:
/// 1/4).
inline Floats mean_of_positive(Floats mean, Floats spread) {
  return 0.5F * (mean + root(mean * mean + 0.25F * spread));
}

inline Floats absolute(Floats x) { return x < 0 ? -x : x; }
inline Floats positive(Floats x) { return x > 0 ? x : Floats{}; }
struct Pick {
  int index = 0;
  Float u = 0;  ///< what is left of the number, in [0, 1) again
};
/// An index in proportion to its weight; the last one with weight takes what rounding leaves over.
template <typename WeightOf>
Pick pick(int size, Float sum, Float u, const WeightOf& weight_of) {
  Float rest = u * sum;
  Pick pick;
  for (int i = 0; i < size; ++i) {
    const Float weight = weight_of(i);
    if (!(weight > 0)) continue;
    pick = {i, std::min(rest / weight, kOneMinusEpsilon)};
    if (rest < weight) break;
    rest -= weight;
  }
  return pick;
}

}  // namespace

LightTree::Weights LightTree::weigh(const Node& node, const Receiver& receiver) {
  const Vec3 p = receiver.position, n = receiver.normal;
  const Floats x = floats(node.x) - floats(p.x), y = floats(node.y) - floats(p.y),
               z = floats(node.z) - floats(p.z);
  const Floats hx = floats(node.half_x), hy = floats(node.half_y), hz = floats(node.half_z);
  const Floats d2 = x * x + y * y + z * z, r2 = hx * hx + hy * hy + hz * hz;
  const Floats inv_d = 1 / root(d2 + std::numeric_limits<float>::min());
  // Directions to a sphere spread about that to its centre by their sine, r / d; within it by all.
  const Floats spread = r2 < d2 ? r2 / d2 : Floats{} + 1;
  const Floats along =
      -(x * floats(node.directed_x) + y * floats(node.directed_y) + z * floats(node.directed_z)) * inv_d;
  const Floats emitted =
      floats(node.around) +
      mean_of_positive(along, floats(node.disagreement) + floats(node.facing_squared) * spread);
  // Intensity · cosine / d², as Conty Estevez and Kulla 2018, eq. 3, but means where they bound. That of 1 /
  // d² is from afar 1 / d², at the centre of a ball 3 / r².
  const Floats within = r2 * (1 / 3.F);
  Floats weight = emitted / (d2 < within ? within : d2);
  if (!(n == Vec3{})) {
    const Floats cosine = (x * floats(n.x) + y * floats(n.y) + z * floats(n.z)) * inv_d;
    weight *= mean_of_positive(cosine, spread);
  }
  const Floats out_x = positive(absolute(x) - hx), out_y = positive(absolute(y) - hy),
               out_z = positive(absolute(z) - hz);
  const auto near = out_x * out_x + out_y * out_y + out_z * out_z < r2;
  Weights weights;
  store(weight, weights.child);
  store(near ? Floats{} + 1 : Floats{}, weights.near);
  weights.sum = weight[0] + weight[1] + weight[2] + weight[3];
  return weights;
}

LightTree::Cut::Cut(const LightTree& tree, const Receiver& receiver) {
  if (tree.empty()) return;
  add_children(tree, receiver, 0, 0, 0);
  // Level by level, and none by half: a near part left whole beside others that are opened is estimated too
  // low, which is worse than to open none.
  int opened = 0;
  for (int begin = 0;;) {
    const int end = size_, opening = count_opening(begin);
    opened += opening;
    if (opening == 0 || opened > kMaxOpened) break;
    for (; begin < end; ++begin) {
      Part& part = parts_[std::size_t(begin)];
      if (!part.opens) continue;
      part.weight = 0;
      add_children(tree, receiver, part.child, part.trail, part.depth);
    }
  }
  for (int i = 0; i < size_; ++i) sum_ += parts_[std::size_t(i)].weight;
}

int LightTree::Cut::count_opening(int begin) const {
  return int(std::count_if(parts_.begin() + begin, parts_.begin() + size_,
                           [](const Part& part) { return part.opens; }));
}

void LightTree::Cut::add_children(const LightTree& tree, const Receiver& receiver, std::uint32_t node,
                                  std::uint64_t trail, int depth) {
  const Weights weights = weigh(tree.nodes_[node], receiver);
  for (std::size_t i = 0; i < std::size_t(kWidth); ++i) {
    if (!(weights.child[i] > 0)) continue;
    const std::uint32_t child = tree.nodes_[node].child[i];
    parts_[std::size_t(size_++)] = {weights.child[i], child, trail | std::uint64_t(i) << (kTrailBits * depth),
                                    depth + 1, weights.near[i] > 0 && (child & kLeafBit) == 0};
  }
}

LightTree::Choice LightTree::choose(const Cut& cut, const Receiver& receiver, Float u) const {
  const auto part_weight = [&](int i) { return Float(cut.parts_[std::size_t(i)].weight); };
  Pick next = pick(cut.size_, cut.sum_, u, part_weight);
  const Cut::Part& part = cut.parts_[std::size_t(next.index)];
  Choice choice{part.child, part.weight / cut.sum_};
  while ((choice.light & kLeafBit) == 0) {
    const Node& node = nodes_[choice.light];
    const Weights weights = weigh(node, receiver);
    if (!(weights.sum > 0)) return {};  // it was no more than rounding
    next = pick(kWidth, weights.sum, next.u, [&](int i) { return weights.child[std::size_t(i)]; });
    choice.probability *= weights.child[std::size_t(next.index)] / weights.sum;
    choice.light = node.child[std::size_t(next.index)];
  }
  choice.light &= ~kLeafBit;
  return choice;
}

Float LightTree::probability(const Cut& cut, const Receiver& receiver, std::uint32_t light) const {
  if (light >= present_.size() || !present_[light]) return 0;
  const std::uint64_t trail = trails_[light];
  const auto leads_to = [&](const Cut::Part& part) {
    return part.weight > 0 && (trail ^ part.trail) << (64 - kTrailBits * part.depth) == 0;
  };
  const auto end = cut.parts_.begin() + cut.size_;
  const auto part = std::find_if(cut.parts_.begin(), end, leads_to);
  if (part == end) return 0;
  Float probability = part->weight / cut.sum_;
  std::uint32_t next = part->child;
  for (int depth = part->depth; (next & kLeafBit) == 0; ++depth) {
    const Weights weights = weigh(nodes_[next], receiver);
    if (!(weights.sum > 0)) return 0;
    const auto child = std::size_t(trail >> (kTrailBits * depth)) % kWidth;
    probability *= weights.child[child] / weights.sum;
    next = nodes_[next].child[child];
  }
  return probability;
}

}  // namespace spectrace
