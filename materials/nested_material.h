// SPDX-License-Identifier: Apache-2.0
// A material as part of another (ADR 0010).
#pragma once

#include <memory>

#include "materials/bsdf.h"

namespace spectrace {

/// Holds a Material, which has materials like those that hold this among its kinds: defined in material.h.
struct MaterialNode;

/// Shared and immutable. Unlike the material itself it may be asked from either side: one that does not tell
/// its sides apart is turned to face wo, as the renderer does.
class NestedMaterial {
 public:
  explicit NestedMaterial(std::shared_ptr<const MaterialNode> node) : node_(std::move(node)) {}

  [[nodiscard]] BsdfValue evaluate(Vec3 wo, Vec3 wi, const ShadingPoint& at) const;
  [[nodiscard]] LobeValues evaluate_lobes(Vec3 wo, Vec3 wi, const ShadingPoint& at) const;
  [[nodiscard]] std::optional<BsdfSample> sample(Vec3 wo, const BsdfRandom& u, const ShadingPoint& at) const;
  [[nodiscard]] bool is_delta() const;
  /// Share of light that goes straight on through holes, seen from one side: see pass_through(Material).
  [[nodiscard]] Float pass_through(bool from_front, const ShadingPoint& at) const;

  [[nodiscard]] const MaterialNode& node() const { return *node_; }

 private:
  std::shared_ptr<const MaterialNode> node_;
};

}  // namespace spectrace
