// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "core/image/data_texture.h"
#include "materials/nested_material.h"

namespace spectrace {

/// A material with holes: where the opacity is below 1, the rest of the light goes straight on, unbent and
/// unscaled, as if nothing was there.
class Masked {
 public:
  Masked(NestedMaterial material, ScalarTexture opacity)
      : material_(std::move(material)), opacity_(std::move(opacity)) {}

  [[nodiscard]] BsdfValue evaluate(Vec3 wo, Vec3 wi, const ShadingPoint& at) const;
  [[nodiscard]] LobeValues evaluate_lobes(Vec3 wo, Vec3 wi, const ShadingPoint& at) const;
  /// Passes with probability 1 - opacity, a delta lobe of weight 1.
  [[nodiscard]] std::optional<BsdfSample> sample(Vec3 wo, const BsdfRandom& u, const ShadingPoint& at) const;
  [[nodiscard]] bool is_delta() const { return material_.is_delta(); }
  [[nodiscard]] Float pass_through(bool from_front, const ShadingPoint& at) const;

  [[nodiscard]] const auto& texture() const { return opacity_; }
  [[nodiscard]] std::array<const NestedMaterial*, 1> parts() const { return {&material_}; }

 private:
  NestedMaterial material_;
  ScalarTexture opacity_;
};

static_assert(Bsdf<Masked>);

}  // namespace spectrace
