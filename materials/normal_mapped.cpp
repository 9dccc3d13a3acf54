// SPDX-License-Identifier: Apache-2.0
#include "materials/normal_mapped.h"

#include <algorithm>
#include <cmath>

namespace spectrace {

namespace {

/// How far above the bent horizon wo must stand (cosine), or as far as above the true one: as the renderer's
/// kMinShadingCosine.
constexpr Float kMinCosine = Float(1e-3);

/// Around the bent normal, with x along u.
Frame bent_frame(const NormalTexture& normals, Vec3 wo, const ShadingPoint& at) {
  Vec3 n = normals.at(at.uv, at.footprint);
  n.y *= at.v_sign;
  const Float side = wo.z < 0 ? Float(-1) : Float(1);
  const Float cosine = dot(wo, n) * side;
  const Float wanted = std::min(kMinCosine, wo.z * side);
  if (cosine < wanted) n = normalize(n + wo * (side * (wanted - cosine)));
  const Vec3 across{n.z, 0, -n.x};  // in the plane of x and z, where n never lies along y
  const Float length2 = length_squared(across);
  if (!(length2 > 0)) return Frame::from_normal(n);
  const Vec3 s = across / std::sqrt(length2);
  return {s, cross(n, s), n};
}

bool same_side(Vec3 w, Vec3 bent) { return w.z * bent.z > 0; }

}  // namespace

BsdfValue NormalMapped::evaluate(Vec3 wo, Vec3 wi, const ShadingPoint& at) const {
  const Frame frame = bent_frame(normals_, wo, at);
  const Vec3 bent_o = frame.to_local(wo), bent_i = frame.to_local(wi);
  if (!same_side(wo, bent_o) || !same_side(wi, bent_i)) return {};
  return material_.evaluate(bent_o, bent_i, at);
}

LobeValues NormalMapped::evaluate_lobes(Vec3 wo, Vec3 wi, const ShadingPoint& at) const {
  const Frame frame = bent_frame(normals_, wo, at);
  const Vec3 bent_o = frame.to_local(wo), bent_i = frame.to_local(wi);
  if (!same_side(wo, bent_o) || !same_side(wi, bent_i)) return {};
  return material_.evaluate_lobes(bent_o, bent_i, at);
}

std::optional<BsdfSample> NormalMapped::sample(Vec3 wo, const BsdfRandom& u, const ShadingPoint& at) const {
  const Frame frame = bent_frame(normals_, wo, at);
  const Vec3 bent_o = frame.to_local(wo);
  if (!same_side(wo, bent_o)) return std::nullopt;
  std::optional<BsdfSample> s = material_.sample(bent_o, u, at);
  if (!s) return std::nullopt;
  const Vec3 bent_i = s->wi;
  s->wi = s->passes ? -wo : normalize(frame.to_world(bent_i));
  if (!same_side(s->wi, bent_i)) return std::nullopt;
  return s;
}

}  // namespace spectrace
