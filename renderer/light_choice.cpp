// SPDX-License-Identifier: Apache-2.0
// The choice between lights: a part of class Lights.
#include <algorithm>

#include "core/math/math.h"
#include "renderer/lights.h"

namespace spectrace {

namespace {

/// Irradiance on the receiver of a distant light of `irradiance` on a surface that faces it.
float received(Vec3 to_light, float irradiance, Vec3 normal) {
  if (to_light == Vec3{} || normal == Vec3{}) return irradiance;
  return irradiance * std::max(float(dot(to_light, normal)), 0.F);
}

}  // namespace

std::optional<std::uint32_t> Lights::choose_from_table(Float u) const {
  const double target = double(u) * cumulative_.back();
  const auto above = std::upper_bound(cumulative_.begin(), cumulative_.end(), target);
  const auto index = std::min<std::size_t>(above - cumulative_.begin(), cumulative_.size() - 1);
  if (!(probability_[index] > 0)) {
    return std::nullopt;  // a share that Float cannot hold
  }
  return std::uint32_t(index);
}

Float Lights::total(const Receiver& receiver, const LightTree::Cut& cut) const {
  float total = cut.sum();
  for (const Distant& distant : distant_) {
    total += received(distant.to_light, distant.irradiance, receiver.normal);
  }
  return total;
}

Lights::Choice Lights::choose_by_estimate(const Receiver& receiver, Float u) const {
  const LightTree::Cut cut(tree_, receiver);
  const Float all = total(receiver, cut);
  Float rest = u * all;
  if (rest < cut.sum()) {
    Choice choice = tree_.choose(cut, receiver, std::min(rest / cut.sum(), kOneMinusEpsilon));
    choice.probability *= cut.sum() / all;
    return choice;
  }
  rest -= cut.sum();
  Choice choice;
  for (const Distant& distant : distant_) {
    const Float weight = received(distant.to_light, distant.irradiance, receiver.normal);
    if (!(weight > 0)) continue;
    choice = {distant.light, weight / all};
    if (rest < weight) break;
    rest -= weight;
  }
  return choice;
}

Float Lights::estimate_share(std::uint32_t light, const Receiver& receiver) const {
  const LightTree::Cut cut(tree_, receiver);
  const Float all = total(receiver, cut);
  if (!(all > 0)) return 0;
  const auto distant =
      std::find_if(distant_.begin(), distant_.end(), [&](const Distant& d) { return d.light == light; });
  if (distant != distant_.end()) {
    return received(distant->to_light, distant->irradiance, receiver.normal) / all;
  }
  return tree_.probability(cut, receiver, light) * (cut.sum() / all);
}

Float Lights::joint(Float table, Float estimate) const {
  return table_share_ * table + (1 - table_share_) * estimate;
}

std::optional<Lights::Choice> Lights::choose(const Receiver& receiver, Float u) const {
  if (cumulative_.empty()) return std::nullopt;
  if (u < table_share_) {
    const auto light = choose_from_table(std::min(u / table_share_, kOneMinusEpsilon));
    if (!light) return std::nullopt;
    return Choice{*light, probability(*light, receiver)};
  }
  const Choice choice = choose_by_estimate(receiver, (u - table_share_) / (1 - table_share_));
  if (!(choice.probability > 0)) return std::nullopt;
  return Choice{choice.light, joint(probability_[choice.light], choice.probability)};
}

Float Lights::probability(std::uint32_t light, const Receiver& receiver) const {
  if (table_share_ >= 1) return probability_[light];
  return joint(probability_[light], estimate_share(light, receiver));
}

}  // namespace spectrace
