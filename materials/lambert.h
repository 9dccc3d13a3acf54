// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/image/texture.h"
#include "materials/bsdf.h"

namespace spectrace {

/// f = reflectance / π.
struct Lambert {
  Texture reflectance;  ///< in [0, 1]

  static constexpr Lobe kOnlyLobe = Lobe::kDiffuse;
  [[nodiscard]] BsdfValue evaluate(Vec3 wo, Vec3 wi, const ShadingPoint& at) const;
  [[nodiscard]] LobeValues evaluate_lobes(Vec3 wo, Vec3 wi, const ShadingPoint& at) const;
  [[nodiscard]] std::optional<BsdfSample> sample(Vec3 wo, const BsdfRandom& u, const ShadingPoint& at) const;
  /// Looks the reflectance up once for both.
  [[nodiscard]] Scattering scatter(Vec3 wo, const Vec3* light, const BsdfRandom& u,
                                   const ShadingPoint& at) const;
  [[nodiscard]] bool is_delta() const { return false; }
  /// Share of light that the diffuse lobe sends to wo from all around.
  [[nodiscard]] SampledSpectrum diffuse_albedo(Vec3, const ShadingPoint& at) const {
    return reflectance.sample(at.lambda, at.uv, at.footprint);
  }
};

/// Directions in proportion to cosθ / π: Malley's method over a concentric disk (Shirley & Chiu 1997).
[[nodiscard]] Vec3 sample_cosine_hemisphere(Vec2 u);

/// For a BSDF that is compared with others rather than rendered: its value in a direction drawn by the
/// cosine.
template <typename B>
[[nodiscard]] std::optional<BsdfSample> sample_by_cosine(const B& bsdf, Vec3 wo, const BsdfRandom& u,
                                                         const ShadingPoint& at) {
  if (!(wo.z > 0)) return std::nullopt;
  const Vec3 wi = sample_cosine_hemisphere(u.direction);
  const BsdfValue value = bsdf.evaluate(wo, wi, at);
  if (!(value.pdf > 0)) return std::nullopt;
  return BsdfSample{
      .wi = wi, .weight = value.value_cos / value.pdf, .pdf = value.pdf, .lobe = Lobe::kSpecular};
}

static_assert(Bsdf<Lambert>);

}  // namespace spectrace
