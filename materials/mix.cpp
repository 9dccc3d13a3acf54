// SPDX-License-Identifier: Apache-2.0
#include "materials/mix.h"

#include "core/math/math.h"

namespace spectrace {

BsdfValue Mix::evaluate(Vec3 wo, Vec3 wi, const ShadingPoint& at) const {
  const Float w = weight_.at(at.uv, at.footprint);
  // A material that covers nothing is not asked: it costs nothing, and its rounding leaves no trace.
  if (w <= 0) return first_.evaluate(wo, wi, at);
  if (w >= 1) return second_.evaluate(wo, wi, at);
  const BsdfValue a = first_.evaluate(wo, wi, at), b = second_.evaluate(wo, wi, at);
  return {a.value_cos * (1 - w) + b.value_cos * w, lerp(a.pdf, b.pdf, w)};
}

LobeValues Mix::evaluate_lobes(Vec3 wo, Vec3 wi, const ShadingPoint& at) const {
  const Float w = weight_.at(at.uv, at.footprint);
  if (w <= 0) return first_.evaluate_lobes(wo, wi, at);
  if (w >= 1) return second_.evaluate_lobes(wo, wi, at);
  const LobeValues a = first_.evaluate_lobes(wo, wi, at), b = second_.evaluate_lobes(wo, wi, at);
  return {.diffuse = a.diffuse * (1 - w) + b.diffuse * w,
          .fresnel = a.fresnel * (1 - w) + b.fresnel * w,
          .diffraction = a.diffraction * (1 - w) + b.diffraction * w,
          .residual = a.residual * (1 - w) + b.residual * w};
}

std::optional<BsdfSample> Mix::sample(Vec3 wo, const BsdfRandom& u, const ShadingPoint& at) const {
  const Float w = weight_.at(at.uv, at.footprint);
  if (w <= 0) return first_.sample(wo, u, at);
  if (w >= 1) return second_.sample(wo, u, at);
  const bool choose_second = u.lobe < w;
  const Float share = choose_second ? w : 1 - w;
  // What is left of the number, after the choice, is even again.
  const Float rest = std::min((choose_second ? u.lobe : u.lobe - w) / share, Float(1));
  std::optional<BsdfSample> s = (choose_second ? second_ : first_).sample(wo, {rest, u.direction}, at);
  if (!s) return std::nullopt;
  if (s->is_delta) {
    s->pdf *= share;  // and its value is the share's too: the weight stays
    return s;
  }
  const BsdfValue value = evaluate(wo, s->wi, at);
  if (!(value.pdf > 0)) return std::nullopt;
  s->weight = value.value_cos / value.pdf;
  s->pdf = value.pdf;
  return s;
}

Float Mix::pass_through(bool from_front, const ShadingPoint& at) const {
  return lerp(first_.pass_through(from_front, at), second_.pass_through(from_front, at),
              weight_.at(at.uv, at.footprint));
}

}  // namespace spectrace
