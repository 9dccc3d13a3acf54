// SPDX-License-Identifier: Apache-2.0
// The separated material as a BSDF: a Lambert lobe and a tabulated specular lobe, evaluated apart.
#pragma once

#include <memory>
#include <optional>

#include "materials/bsdf.h"
#include "materials/separated_tables.h"

namespace spectrace {

/// Cheap to copy. Reciprocal by construction.
class SeparatedBrdf {
 public:
  SeparatedBrdf(std::shared_ptr<const SeparatedTables> tables, SeparationModel model);

  [[nodiscard]] BsdfValue evaluate(Vec3 wo, Vec3 wi, const ShadingPoint& at) const;
  /// diffuse = the Lambert lobe; diffraction = ρ_s (s_D - s_F) in the diffraction model (eq. 21), else 0.
  [[nodiscard]] LobeValues evaluate_lobes(Vec3 wo, Vec3 wi, const ShadingPoint& at) const;
  /// Chooses the lobe by its expected energy at wo over the lanes; an empty lobe is never chosen.
  [[nodiscard]] std::optional<BsdfSample> sample(Vec3 wo, const BsdfRandom& u, const ShadingPoint& at) const;
  [[nodiscard]] bool is_delta() const { return false; }

  [[nodiscard]] SeparationModel model() const { return model_; }
  [[nodiscard]] const SeparatedTables& tables() const;

 private:
  struct Data;  // the sampling tables of the specular lobe
  std::shared_ptr<const Data> data_;
  SeparationModel model_;
};

static_assert(Bsdf<SeparatedBrdf>);

}  // namespace spectrace
