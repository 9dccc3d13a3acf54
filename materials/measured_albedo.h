// SPDX-License-Identifier: Apache-2.0
// How much of the incident light a measurement reflects: noise at grazing elevations makes some reflect more
// than all of it.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "materials/measured_brdf.h"

namespace spectrace {

struct AlbedoPeak {
  double albedo = 0;      ///< ∫ f cosθ dω over the upper hemisphere
  double theta_deg = 0;   ///< elevation of wo from the normal, one of those measured
  std::size_t index = 0;  ///< on the spectral axis
};
/// The largest over the measured incident directions and the spectral axis. Evaluates about a thousand
/// directions each.
AlbedoPeak largest_albedo(const MeasuredBrdf& measured);

/// "albedo 1.07 at 78 degrees and 465 nm: the measurement reflects more light than it receives", of a peak
/// above 1. Values are kept as measured: paths end by Russian roulette and depth whatever they are.
std::optional<std::string> albedo_warning(const AlbedoPeak& peak, const SpectralAxis& axis);

}  // namespace spectrace
