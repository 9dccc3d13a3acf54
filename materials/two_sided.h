// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "materials/nested_material.h"

namespace spectrace {

/// One material in front, where the surface's normal points to, and one behind.
class TwoSided {
 public:
  TwoSided(NestedMaterial front, NestedMaterial back) : front_(std::move(front)), back_(std::move(back)) {}

  [[nodiscard]] BsdfValue evaluate(Vec3 wo, Vec3 wi, const ShadingPoint& at) const {
    return facing(wo).evaluate(wo, wi, at);
  }
  [[nodiscard]] LobeValues evaluate_lobes(Vec3 wo, Vec3 wi, const ShadingPoint& at) const {
    return facing(wo).evaluate_lobes(wo, wi, at);
  }
  [[nodiscard]] std::optional<BsdfSample> sample(Vec3 wo, const BsdfRandom& u, const ShadingPoint& at) const {
    return facing(wo).sample(wo, u, at);
  }
  [[nodiscard]] bool is_delta() const { return front_.is_delta() && back_.is_delta(); }
  [[nodiscard]] Float pass_through(bool from_front, const ShadingPoint& at) const {
    return (from_front ? front_ : back_).pass_through(from_front, at);
  }
  [[nodiscard]] std::array<const NestedMaterial*, 2> parts() const { return {&front_, &back_}; }

 private:
  [[nodiscard]] const NestedMaterial& facing(Vec3 wo) const { return wo.z < 0 ? back_ : front_; }

  NestedMaterial front_, back_;
};

static_assert(Bsdf<TwoSided>);

}  // namespace spectrace
