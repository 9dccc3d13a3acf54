// SPDX-License-Identifier: Apache-2.0
// The residual model: a few terms in direction x wavelength for what the diffraction model leaves (ADR 0007).
#pragma once

#include "materials/measured_brdf.h"
#include "materials/separated_tables.h"
#include "separation/separate.h"

namespace spectrace {

struct ResidualReport {
  /// Share of the squared residual, weighted by solid angle, that the terms explain: 1 for RGB.
  double explained = 0;
  /// Of the ratios: beyond what a byte times the step holds. Those of the odd terms, which are clamped near
  /// the horizon, count by the factor they are multiplied with, which vanishes there.
  double clamped_share = 0, odd_clamped_share = 0;
};

/// Principal components of (X - diffraction model) / M over the axis, M the model's mean at each node, of
/// what is even and, unless `options.reciprocal`, of what is odd in the exchange of the directions; at most
/// `options.residual_rank` of them, in [1, kMaxResidualRank], fewer where fewer explain all. Fits to every
/// node that has a value. The same for any number of threads; runs on those of with_threads().
ResidualTable fit_residual(const MeasuredBrdf& measured, const SeparatedTables& tables,
                           const SeparationOptions& options, ResidualReport& report);

}  // namespace spectrace
