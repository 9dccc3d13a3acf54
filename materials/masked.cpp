// SPDX-License-Identifier: Apache-2.0
#include "materials/masked.h"

#include <algorithm>

namespace spectrace {

BsdfValue Masked::evaluate(Vec3 wo, Vec3 wi, const ShadingPoint& at) const {
  const Float opacity = opacity_.at(at.uv, at.footprint);
  if (opacity <= 0) return {};
  const BsdfValue value = material_.evaluate(wo, wi, at);
  return {value.value_cos * opacity, value.pdf * opacity};
}

LobeValues Masked::evaluate_lobes(Vec3 wo, Vec3 wi, const ShadingPoint& at) const {
  const Float opacity = opacity_.at(at.uv, at.footprint);
  if (opacity <= 0) return {};
  const LobeValues lobes = material_.evaluate_lobes(wo, wi, at);
  return {.diffuse = lobes.diffuse * opacity,
          .fresnel = lobes.fresnel * opacity,
          .diffraction = lobes.diffraction * opacity,
          .residual = lobes.residual * opacity};
}

std::optional<BsdfSample> Masked::sample(Vec3 wo, const BsdfRandom& u, const ShadingPoint& at) const {
  const Float opacity = opacity_.at(at.uv, at.footprint);
  if (opacity < 1 && (opacity <= 0 || u.lobe >= opacity)) {
    if (wo.z == 0) return std::nullopt;
    return BsdfSample{.wi = -wo,
                      .weight = SampledSpectrum(1),
                      .pdf = 1 - opacity,
                      .lobe = Lobe::kSpecular,
                      .is_delta = true,
                      .passes = true};
  }
  std::optional<BsdfSample> s = material_.sample(wo, {std::min(u.lobe / opacity, Float(1)), u.direction}, at);
  // Value and density both have the opacity: the weight stays. An inner hole's weight does, too.
  if (s) s->pdf *= opacity;
  return s;
}

Float Masked::pass_through(bool from_front, const ShadingPoint& at) const {
  const Float opacity = opacity_.at(at.uv, at.footprint);
  return 1 - opacity + opacity * material_.pass_through(from_front, at);
}

}  // namespace spectrace
