// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "core/image/data_texture.h"
#include "materials/nested_material.h"

namespace spectrace {

/// A material turned to the normals of a texture. A back shows the same bumps from behind.
/// No light leaks: wi must lie on one and the same side of the surface and of the bent surface. A normal that
/// turns away from wo is bent back until wo lies just above its horizon, as the renderer does with
/// interpolated normals. Either makes the material lose light and not be reciprocal, and neither makes any.
class NormalMapped {
 public:
  NormalMapped(NestedMaterial material, NormalTexture normals)
      : material_(std::move(material)), normals_(std::move(normals)) {}

  [[nodiscard]] BsdfValue evaluate(Vec3 wo, Vec3 wi, const ShadingPoint& at) const;
  [[nodiscard]] LobeValues evaluate_lobes(Vec3 wo, Vec3 wi, const ShadingPoint& at) const;
  [[nodiscard]] std::optional<BsdfSample> sample(Vec3 wo, const BsdfRandom& u, const ShadingPoint& at) const;
  [[nodiscard]] bool is_delta() const { return material_.is_delta(); }
  [[nodiscard]] const auto& texture() const { return normals_; }
  [[nodiscard]] Float pass_through(bool from_front, const ShadingPoint& at) const {
    return material_.pass_through(from_front, at);
  }
  [[nodiscard]] std::array<const NestedMaterial*, 1> parts() const { return {&material_}; }

 private:
  NestedMaterial material_;
  NormalTexture normals_;
};

static_assert(Bsdf<NormalMapped>);

}  // namespace spectrace
