// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "core/image/data_texture.h"
#include "materials/nested_material.h"

namespace spectrace {

/// (1 - weight) of the first material and weight of the second: shares of the surface that each covers.
class Mix {
 public:
  Mix(NestedMaterial first, NestedMaterial second, ScalarTexture weight)
      : first_(std::move(first)), second_(std::move(second)), weight_(std::move(weight)) {}

  [[nodiscard]] BsdfValue evaluate(Vec3 wo, Vec3 wi, const ShadingPoint& at) const;
  [[nodiscard]] LobeValues evaluate_lobes(Vec3 wo, Vec3 wi, const ShadingPoint& at) const;
  /// Chooses the material by its share; a direction that is no delta is weighed with both.
  [[nodiscard]] std::optional<BsdfSample> sample(Vec3 wo, const BsdfRandom& u, const ShadingPoint& at) const;
  [[nodiscard]] bool is_delta() const { return first_.is_delta() && second_.is_delta(); }
  [[nodiscard]] Float pass_through(bool from_front, const ShadingPoint& at) const;

  /// Of the second material.
  [[nodiscard]] Float weight(const ShadingPoint& at) const { return weight_.at(at.uv, at.footprint); }
  [[nodiscard]] const auto& texture() const { return weight_; }
  [[nodiscard]] std::array<const NestedMaterial*, 2> parts() const { return {&first_, &second_}; }

 private:
  NestedMaterial first_, second_;
  ScalarTexture weight_;
};

static_assert(Bsdf<Mix>);

}  // namespace spectrace
