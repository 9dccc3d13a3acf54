// SPDX-License-Identifier: Apache-2.0
// Both orders of a pair of directions, looked up in a measurement and averaged.
#pragma once

#include <array>

#include "materials/half_difference.h"
#include "materials/measured_brdf.h"

namespace spectrace {

/// Rows and weights whose sum is q = f̂ (cosθi + cosθo) at a pair of directions above the horizon, f̂ the mean
/// of both orders.
struct ReciprocalPair {
  std::array<MeasuredBrdf::Footprint, 2> footprint;
  std::array<double, 2> scale{};  ///< of each footprint's weights
  bool measured = false;          ///< in both orders, or in one from which f̂ can be told
  bool extrapolated = false;      ///< beyond the last measured elevation in every order that was not measured
  bool any = false;               ///< at least one order holds a value
  bool both = false;              ///< both orders do, and q is the sum of both

  /// Weights of the footprints whose sum is what q loses of f cosθi: (f(wo, wi) - f(wi, wo)) cosθi cosθo /
  /// (cosθi + cosθo). 0 where one order stands for both.
  [[nodiscard]] std::array<double, 2> odd_scale(const DirectionPair& directions) const;
};

ReciprocalPair locate_pair(const MeasuredBrdf& measured, const DirectionPair& directions);

}  // namespace spectrace
