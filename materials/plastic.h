// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "core/image/texture.h"
#include "materials/bsdf.h"
#include "materials/coat_albedo.h"
#include "materials/microfacet.h"

namespace spectrace {

/// A diffuse base under a clear coat: f = f_coat + T(θo) T(θi) / η² · ρ / (1 - ρ F_in) / π.
/// f_coat is GGX reflection, or a mirror (a delta lobe) where alpha = 0. T = 1 - E, where E is the coat's own
/// directional albedo, so that what a single reflection among the facets loses goes into the base. F_in is
/// how much of the diffuse light below the coat it throws back: the series over all bounces between base and
/// coat makes dark colours darker and deepens the others. With F_in = 1 - ∫ T cos / (π η²), as Helmholtz
/// reciprocity demands, a white base sends back exactly what arrives, at any roughness. Saunderson's
/// correction (1942) says the same of diffuse light.
/// One alpha: E of an anisotropic coat would depend on the azimuth as well.
class Plastic {
 public:
  /// `reflectance` of the base in [0, 1]; `eta` of the coat in [1, kMaxCoatEta]; `alpha` 0 or in [kMinAlpha,
  /// 1].
  Plastic(Texture reflectance, Spectrum eta, Float alpha);

  [[nodiscard]] BsdfValue evaluate(Vec3 wo, Vec3 wi, const ShadingPoint& at) const;
  [[nodiscard]] LobeValues evaluate_lobes(Vec3 wo, Vec3 wi, const ShadingPoint& at) const;
  /// Chooses the lobe by its albedo seen from wo, averaged over the lanes.
  [[nodiscard]] std::optional<BsdfSample> sample(Vec3 wo, const BsdfRandom& u, const ShadingPoint& at) const;
  [[nodiscard]] bool is_delta() const { return false; }
  /// Share of light that the diffuse lobe sends to wo from all around.
  [[nodiscard]] SampledSpectrum diffuse_albedo(Vec3 wo, const ShadingPoint& at) const {
    return view(wo, at).diffuse_albedo;
  }
  [[nodiscard]] bool has_delta_lobe() const { return alpha_ == 0; }

  [[nodiscard]] const auto& texture() const { return reflectance_; }
  [[nodiscard]] Float alpha() const { return alpha_; }

 private:
  /// What depends on wo alone: found once a sample.
  struct View {
    SampledSpectrum eta;
    SampledSpectrum coat_albedo;   // E(θo)
    SampledSpectrum diffuse_part;  // of the diffuse lobe all but T(θi) cosθi / π
    SampledSpectrum diffuse_albedo;
    Float coat_probability = 0;
  };
  [[nodiscard]] View view(Vec3 wo, const ShadingPoint& at) const;
  [[nodiscard]] SampledSpectrum diffuse(const View& view, Vec3 wi) const;
  [[nodiscard]] SampledSpectrum coat(const View& view, const Ggx::Reflection& r) const;
  [[nodiscard]] BsdfValue evaluate(const View& view, Vec3 wo, Vec3 wi) const;

  Texture reflectance_;
  Spectrum eta_;
  Float alpha_;
  Ggx ggx_;
  std::shared_ptr<const CoatAlbedo> albedo_;
};

static_assert(Bsdf<Plastic>);

}  // namespace spectrace
