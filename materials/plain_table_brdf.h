// SPDX-License-Identifier: Apache-2.0
// The table X at its plainest: what this project's own table (materials/tabulated_brdf.h) is measured
// against.
#pragma once

#include <memory>
#include <optional>

#include "materials/bsdf.h"
#include "materials/tabulated_brdf.h"

namespace spectrace {

/// X as the paper describes it: f itself, in one order of the pair, looked up trilinearly in the coordinates
/// of its nodes; nodes without a value (NaN) count for nothing. A baseline for figures, not for rendering: it
/// is neither reciprocal nor bounded at grazing.
class PlainTableBrdf {
 public:
  /// Of `table`, q holds f [1/sr] and not its bounded form.
  explicit PlainTableBrdf(std::shared_ptr<const HalfDifferenceTable> table);

  [[nodiscard]] BsdfValue evaluate(Vec3 wo, Vec3 wi, const ShadingPoint& at) const;
  /// All of it is `fresnel`, that is, specular.
  [[nodiscard]] LobeValues evaluate_lobes(Vec3 wo, Vec3 wi, const ShadingPoint& at) const;
  [[nodiscard]] std::optional<BsdfSample> sample(Vec3 wo, const BsdfRandom& u, const ShadingPoint& at) const;
  [[nodiscard]] bool is_delta() const { return false; }

 private:
  std::shared_ptr<const HalfDifferenceTable> table_;
};

static_assert(Bsdf<PlainTableBrdf>);

}  // namespace spectrace
