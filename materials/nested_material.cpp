// SPDX-License-Identifier: Apache-2.0
#include "materials/nested_material.h"

#include "materials/material.h"

namespace spectrace {

namespace {

/// Half a turn about the frame's x, the tangent: what the renderer does to see a back as a front.
Vec3 turned(Vec3 w) { return {w.x, -w.y, -w.z}; }
ShadingPoint turned(const ShadingPoint& at) {
  return {.lambda = at.lambda, .uv = at.uv, .footprint = at.footprint, .v_sign = -at.v_sign};
}

}  // namespace

BsdfValue NestedMaterial::evaluate(Vec3 wo, Vec3 wi, const ShadingPoint& at) const {
  if (wo.z < 0 && !keeps_sides(node_->material)) {
    return spectrace::evaluate(node_->material, turned(wo), turned(wi), turned(at));
  }
  return spectrace::evaluate(node_->material, wo, wi, at);
}

LobeValues NestedMaterial::evaluate_lobes(Vec3 wo, Vec3 wi, const ShadingPoint& at) const {
  if (wo.z < 0 && !keeps_sides(node_->material)) {
    return spectrace::evaluate_lobes(node_->material, turned(wo), turned(wi), turned(at));
  }
  return spectrace::evaluate_lobes(node_->material, wo, wi, at);
}

std::optional<BsdfSample> NestedMaterial::sample(Vec3 wo, const BsdfRandom& u, const ShadingPoint& at) const {
  if (wo.z < 0 && !keeps_sides(node_->material)) {
    std::optional<BsdfSample> s = spectrace::sample(node_->material, turned(wo), u, turned(at));
    if (s) s->wi = turned(s->wi);
    return s;
  }
  return spectrace::sample(node_->material, wo, u, at);
}

bool NestedMaterial::is_delta() const { return spectrace::is_delta(node_->material); }

Float NestedMaterial::pass_through(bool from_front, const ShadingPoint& at) const {
  return spectrace::pass_through(node_->material, from_front, at);
}

}  // namespace spectrace
