// SPDX-License-Identifier: Apache-2.0
#include "separation/reciprocal_pair.h"

#include <optional>

namespace spectrace {
namespace {

// Where only one order of a pair was measured, f̂ = v1 / cosθi, and the other direction lies beyond the last
// measured elevation (78 to 85 degrees in the EPFL files). Nearer the horizon than this the quotient is noise
// divided by nothing (hard case H3), and the average over both orders, which needs no quotient, would be
// nearly all of the order that was not measured (H1): the table takes it to have a value there, no fit does.
constexpr double kMinSingleOrderCosine = 0.05;

}  // namespace

/// v1 = f(wo, wi) cosθi and v2 = f(wi, wo) cosθo are what the file holds, so q = v1 + v2 is the
/// cosine-weighted mean of both orders: no division, bounded at grazing.
ReciprocalPair locate_pair(const MeasuredBrdf& brdf, const DirectionPair& directions) {
  ReciprocalPair pair;
  const std::array<std::optional<MeasuredBrdf::Footprint>, 2> orders{
      brdf.footprint(directions.wo, directions.wi), brdf.footprint(directions.wi, directions.wo)};
  const std::array<double, 2> cosine{directions.wi.z, directions.wo.z};  // what each order is multiplied by
  std::array<bool, 2> measured{};
  for (std::size_t i = 0; i < 2; ++i) {
    if (!orders[i]) continue;
    pair.any = true;
    pair.footprint[i] = *orders[i];
    pair.scale[i] = 1;
    measured[i] = orders[i]->measured;
  }
  pair.extrapolated = pair.any;
  for (std::size_t i = 0; i < 2; ++i) {
    if (orders[i] && !measured[i]) pair.extrapolated = pair.extrapolated && orders[i]->extrapolated;
  }
  pair.both = measured[0] && measured[1];
  pair.measured = pair.both;
  for (std::size_t i = 0; i < 2; ++i) {
    if (measured[i] && !measured[1 - i] && cosine[i] >= kMinSingleOrderCosine) {
      pair.measured = true;
      pair.scale[i] = (cosine[0] + cosine[1]) / cosine[i];
      pair.scale[1 - i] = 0;
    }
  }
  return pair;
}

std::array<double, 2> ReciprocalPair::odd_scale(const DirectionPair& directions) const {
  if (!both) return {0, 0};
  const double share_i = double(directions.wi.z) / (double(directions.wi.z) + double(directions.wo.z));
  return {1 - share_i, -share_i};
}

}  // namespace spectrace
