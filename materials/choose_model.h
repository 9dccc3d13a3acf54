// SPDX-License-Identifier: Apache-2.0
// The cheapest model whose error a user accepts: only what the material calls for is stored and rendered.
#pragma once

#include <string>
#include <vector>

#include "materials/measured_brdf.h"
#include "materials/separated_lookup.h"

namespace spectrace {

/// Of the light the measurement reflects, the share that a model puts elsewhere or leaves out:
/// ∫∫∫ |f - f_model| cosθi dωi dμ(ωo) dλ over ∫∫∫ f cosθi dωi dμ(ωo) dλ, with ωo distributed by its cosine
/// and λ uniformly over the observer's range; by a fixed set of samples, so it is the same each time
/// (standard error about 1 % of itself).
double model_error(const MeasuredBrdf& measured, const SeparatedSource& source, SeparationModel model);

/// What `auto` accepts where nobody says: about what the table X itself differs from the measurement by
/// (docs/separation.md).
inline constexpr double kDefaultTolerance = 0.1;

struct ModelChoice {
  SeparationModel model = SeparationModel::kDiffraction;
  bool within_tolerance = false;
  std::vector<double> errors;  ///< by model, cheapest first, up to the chosen one
  std::string reason;          ///< one line
};

/// The first model, cheapest first, of error at most `tolerance`; where none is, the richest of `source`.
ModelChoice choose_model(const MeasuredBrdf& measured, const SeparatedSource& source, double tolerance);
/// As above where the measurement is not at hand: the richest model of `source` stands for it.
ModelChoice choose_model(const SeparatedSource& source, double tolerance);

}  // namespace spectrace
