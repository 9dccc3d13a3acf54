// SPDX-License-Identifier: Apache-2.0
// The paper's table X as a BSDF: what a separation works on, before it separates anything.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "materials/bsdf.h"
#include "materials/half_difference_grid.h"
#include "materials/spectral_axis.h"

namespace spectrace {

/// X (paper, sec. 4.1): a spectrum a node of the half-difference grid.
struct HalfDifferenceTable {
  HalfDifferenceGrid grid;
  SpectralAxis axis;
  /// [theta_h][theta_d][phi_d][axis]: f · (cosθi + cosθo) >= 0 [1/sr] (ADR 0005).
  std::vector<float> q;
  /// Likewise, or empty: (f(wo, wi) - f(wi, wo)) cosθi cosθo / (cosθi + cosθo), what the average of both
  /// orders loses of f cosθi. Bounded, 0 at the horizon, and odd in the exchange of the directions.
  std::vector<float> odd{};
};

/// The reference of the paper's figures ("tabulated"). Drawn by the cosine: it is compared with others on the
/// directions that those draw (materials/paired_brdf.h), not rendered for its own sake. Cheap to copy.
class TabulatedBrdf {
 public:
  static constexpr Lobe kOnlyLobe = Lobe::kSpecular;
  explicit TabulatedBrdf(std::shared_ptr<const HalfDifferenceTable> table);

  [[nodiscard]] BsdfValue evaluate(Vec3 wo, Vec3 wi, const ShadingPoint& at) const;
  /// Not told apart yet: all of it is `fresnel`, that is, specular.
  [[nodiscard]] LobeValues evaluate_lobes(Vec3 wo, Vec3 wi, const ShadingPoint& at) const;
  [[nodiscard]] std::optional<BsdfSample> sample(Vec3 wo, const BsdfRandom& u, const ShadingPoint& at) const;
  [[nodiscard]] bool is_delta() const { return false; }

 private:
  std::shared_ptr<const HalfDifferenceTable> table_;
};

static_assert(Bsdf<TabulatedBrdf>);

}  // namespace spectrace
