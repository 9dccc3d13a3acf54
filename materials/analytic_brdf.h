// SPDX-License-Identifier: Apache-2.0
// The paper's analytic comparison (sec. 5.3): Lambert + GGX, eqs. 11-15, with parameters of its own at every
// wavelength.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "materials/bsdf.h"
#include "materials/microfacet.h"
#include "materials/spectral_axis.h"

namespace spectrace {

/// The parameters of eq. 12.
struct AnalyticParameters {
  double albedo_d = 0;  ///< alpha_d, [0, 1]
  double rho_0 = 0;     ///< >= 0
  double f_0 = 0;       ///< [0, 1]
  double alpha = 1;     ///< GGX a, [1e-3, 1]
};

/// Eq. 12 (GGX alone, without the Lambert term) at one pair of directions [1/sr], by the cosines of theta_h,
/// theta_d and both directions; finite down to the horizon.
double analytic_specular(const AnalyticParameters& p, double cos_h, double cos_d, double cos_i, double cos_o);

/// Cheap to copy. Reciprocal.
class AnalyticBrdf {
 public:
  /// `parameters`: [4][axis]: albedo_d, rho_0, f_0, alpha, each within its bounds (checked).
  AnalyticBrdf(SpectralAxis axis, const std::vector<float>& parameters);

  [[nodiscard]] BsdfValue evaluate(Vec3 wo, Vec3 wi, const ShadingPoint& at) const;
  [[nodiscard]] LobeValues evaluate_lobes(Vec3 wo, Vec3 wi, const ShadingPoint& at) const;
  /// By the cosine, or by the GGX lobe of the mean roughness: chosen by the energy expected of either at wo,
  /// averaged over the lanes.
  [[nodiscard]] std::optional<BsdfSample> sample(Vec3 wo, const BsdfRandom& u, const ShadingPoint& at) const;
  [[nodiscard]] bool is_delta() const { return false; }

 private:
  [[nodiscard]] SampledSpectrum specular(Vec3 wo, Vec3 wi, const SpectralAxis::Lookup& lookup) const;
  /// Of the samples, for the specular lobe; 0 where there is none.
  [[nodiscard]] Float specular_share(Vec3 wo, const SpectralAxis::Lookup& lookup) const;
  [[nodiscard]] Float pdf(Vec3 wo, Vec3 wi, Float share) const;

  SpectralAxis axis_;
  std::shared_ptr<const std::vector<AnalyticParameters>> at_;  // [axis]
  std::vector<float> albedo_d_;                                // [axis]
  Ggx lobe_;
  std::vector<float> rho_0_, rho_0_f_0_;  // [axis]
  bool is_specular_ = false;
};

static_assert(Bsdf<AnalyticBrdf>);

}  // namespace spectrace
