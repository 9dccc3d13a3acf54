// SPDX-License-Identifier: Apache-2.0
// The values of one BRDF on the directions another draws: images of two descriptions of one material then
// share every random decision, and their difference is the materials' own, not noise.
#pragma once

#include <memory>
#include <optional>
#include <variant>

#include "materials/analytic_brdf.h"
#include "materials/bsdf.h"
#include "materials/conductor.h"
#include "materials/diffractive.h"
#include "materials/glossy.h"
#include "materials/lambert.h"
#include "materials/measured_brdf.h"
#include "materials/plain_table_brdf.h"
#include "materials/separated_brdf.h"
#include "materials/tabulated_brdf.h"

namespace spectrace {

class PairedBrdf {
 public:
  /// Measured, in any description; and what the virtual goniophotometer measures, itself.
  using Values = std::variant<MeasuredBrdf, TabulatedBrdf, PlainTableBrdf, SeparatedBrdf, AnalyticBrdf,
                              Lambert, RoughConductor, Glossy, Diffractive>;
  /// `directions` reaches every direction (a separated material does: it always draws some by the cosine), so
  /// the estimate stays unbiased whatever `values` is. A path is the same for all `values` as long as Russian
  /// roulette, which follows the throughput, is off.
  PairedBrdf(Values values, SeparatedBrdf directions);

  [[nodiscard]] BsdfValue evaluate(Vec3 wo, Vec3 wi, const ShadingPoint& at) const;
  [[nodiscard]] LobeValues evaluate_lobes(Vec3 wo, Vec3 wi, const ShadingPoint& at) const;
  [[nodiscard]] std::optional<BsdfSample> sample(Vec3 wo, const BsdfRandom& u, const ShadingPoint& at) const;
  [[nodiscard]] bool is_delta() const { return false; }
  /// The values, where they are a measurement's.
  [[nodiscard]] const MeasuredBrdf* measured() const { return std::get_if<MeasuredBrdf>(&values_); }
  /// The same of a separated material's.
  [[nodiscard]] const SeparatedBrdf* separated() const { return std::get_if<SeparatedBrdf>(&values_); }

 private:
  Values values_;
  SeparatedBrdf directions_;
};

static_assert(Bsdf<PairedBrdf>);

}  // namespace spectrace
