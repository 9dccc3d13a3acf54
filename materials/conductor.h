// SPDX-License-Identifier: Apache-2.0
// Metals: a mirror and a rough one, each bare or under a thin film.
#pragma once

#include "materials/bsdf.h"
#include "materials/fresnel.h"
#include "materials/microfacet.h"

namespace spectrace {

/// A perfect mirror: one delta lobe.
struct SmoothConductor {
  ConductorFresnel fresnel;

  [[nodiscard]] BsdfValue evaluate(Vec3, Vec3, const ShadingPoint&) const { return {}; }
  [[nodiscard]] LobeValues evaluate_lobes(Vec3, Vec3, const ShadingPoint&) const { return {}; }
  [[nodiscard]] std::optional<BsdfSample> sample(Vec3 wo, const BsdfRandom& u, const ShadingPoint& at) const;
  [[nodiscard]] bool is_delta() const { return true; }
};

/// f = F D G2 / (4 cosθi cosθo): Walter et al. 2007, eq. 20. Single scattering: energy lost between facets
/// is not given back.
struct RoughConductor {
  ConductorFresnel fresnel;
  Ggx ggx;

  static constexpr Lobe kOnlyLobe = Lobe::kSpecular;
  [[nodiscard]] BsdfValue evaluate(Vec3 wo, Vec3 wi, const ShadingPoint& at) const;
  [[nodiscard]] LobeValues evaluate_lobes(Vec3 wo, Vec3 wi, const ShadingPoint& at) const;
  [[nodiscard]] std::optional<BsdfSample> sample(Vec3 wo, const BsdfRandom& u, const ShadingPoint& at) const;
  [[nodiscard]] bool is_delta() const { return false; }
};

static_assert(Bsdf<SmoothConductor> && Bsdf<RoughConductor>);

}  // namespace spectrace
