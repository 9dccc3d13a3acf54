// SPDX-License-Identifier: Apache-2.0
// The separated material as a BSDF: a Lambert lobe and a tabulated specular lobe, evaluated apart.
#pragma once

#include <memory>
#include <optional>

#include "materials/bsdf.h"
#include "materials/separated_lookup.h"

namespace spectrace {

/// Cheap to copy. Reciprocal by construction, but for the odd terms of a residual (ResidualTable::odd).
class SeparatedBrdf {
 public:
  SeparatedBrdf(SeparatedSource source, SeparationModel model);

  [[nodiscard]] BsdfValue evaluate(Vec3 wo, Vec3 wi, const ShadingPoint& at) const;
  /// diffuse = the Lambert lobe; diffraction = ρ_s (s_D - s_F) from the diffraction model on (eq. 21);
  /// residual in the residual model; else 0.
  [[nodiscard]] LobeValues evaluate_lobes(Vec3 wo, Vec3 wi, const ShadingPoint& at) const;
  /// Chooses the lobe by its expected energy at wo over the lanes; an empty lobe is never chosen.
  [[nodiscard]] std::optional<BsdfSample> sample(Vec3 wo, const BsdfRandom& u, const ShadingPoint& at) const;
  [[nodiscard]] bool is_delta() const { return false; }

  [[nodiscard]] SeparationModel model() const;
  /// evaluate_lobes() may tell a diffraction effect or a residual apart.
  [[nodiscard]] bool has_specular_parts() const { return model() >= SeparationModel::kDiffraction; }

 private:
  struct Data;  // the sampling tables of the specular lobe
  std::shared_ptr<const Data> data_;
};

static_assert(Bsdf<SeparatedBrdf>);

}  // namespace spectrace
