// SPDX-License-Identifier: Apache-2.0
// How much of the incident light a measurement reflects: noise at grazing elevations makes some reflect more
// than all of it.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "materials/measured_brdf.h"

namespace spectrace {

/// What becomes of a measurement that reflects more light than it receives.
enum class AlbedoLimit {
  kKeep,   ///< nothing
  kClip,   ///< each incident direction and wavelength of an albedo above 1 is divided by it: reciprocity may
           ///< suffer there
  kScale,  ///< all values are divided by the largest albedo: colours and reciprocity stay
};

struct AlbedoPeak {
  double albedo = 0;      ///< ∫ f cosθ dω over the upper hemisphere
  double theta_deg = 0;   ///< elevation of wo from the normal, one of those measured
  std::size_t index = 0;  ///< on the spectral axis
};
/// The largest over the measured incident directions and the spectral axis. Evaluates about a thousand
/// directions each.
AlbedoPeak largest_albedo(const MeasuredBrdf& measured);

/// Changes `tables.spectra` so that largest_albedo() is at most 1; what has not been measured
/// (last_measured_theta_i()) goes with the last slice that has. Costs what largest_albedo() does.
void limit_albedo(MeasuredTables& tables, AlbedoLimit limit);

/// "albedo 1.07 at 78 degrees and 465 nm: the measurement reflects more light than it receives", of a peak
/// above 1. Paths end by Russian roulette and depth whatever values are.
std::optional<std::string> albedo_warning(const AlbedoPeak& peak, const SpectralAxis& axis);

}  // namespace spectrace
