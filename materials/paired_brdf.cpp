// SPDX-License-Identifier: Apache-2.0
#include "materials/paired_brdf.h"

#include <utility>

namespace spectrace {

PairedBrdf::PairedBrdf(Values values, SeparatedBrdf directions)
    : values_(std::move(values)), directions_(std::move(directions)) {}

BsdfValue PairedBrdf::evaluate(Vec3 wo, Vec3 wi, const ShadingPoint& at) const {
  return {.value_cos = std::visit([&](const auto& b) { return b.evaluate(wo, wi, at).value_cos; }, values_),
          .pdf = directions_.evaluate(wo, wi, at).pdf};
}

LobeValues PairedBrdf::evaluate_lobes(Vec3 wo, Vec3 wi, const ShadingPoint& at) const {
  return std::visit([&](const auto& b) { return b.evaluate_lobes(wo, wi, at); }, values_);
}

std::optional<BsdfSample> PairedBrdf::sample(Vec3 wo, const BsdfRandom& u, const ShadingPoint& at) const {
  std::optional<BsdfSample> drawn = directions_.sample(wo, u, at);
  if (drawn) {
    drawn->weight =
        std::visit([&](const auto& b) { return b.evaluate(wo, drawn->wi, at).value_cos; }, values_) /
        drawn->pdf;
  }
  return drawn;
}

}  // namespace spectrace
