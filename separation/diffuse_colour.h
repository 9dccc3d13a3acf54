// SPDX-License-Identifier: Apache-2.0
// The colour c_d of the Lambert lobe, read where the specular lobe is weakest (docs/separation.md, "The
// diffuse colour"). Beyond the paper, which takes its level from eq. 7 and its spectrum from eq. 18.
#pragma once

#include <optional>
#include <vector>

#include "materials/measured_brdf.h"
#include "separation/cell_table.h"
#include "separation/separate.h"

namespace spectrace {

/// Eq. 12 with a free factor for every theta_d in place of rho_0 and Schlick's F: a thin film, a metal and a
/// real dielectric follow it as well as Schlick's formula does.
struct FreeFresnelFit {
  double albedo_d = 0, alpha = 0;
  std::vector<double> factor;  ///< [theta_d], >= 0
  bool converged = false;
};
/// The least squares of eq. 7 over the cells well above the horizon, begun at `start`.
FreeFresnelFit fit_free_fresnel(const CellTable& table, double epsilon, const AnalyticFit& start);

/// Solves, for every wavelength, the two linear equations that hold for c_d/π plus a lobe of known shape: its
/// mean over the cells where that lobe is weakest, and over those where it is strongest, for each theta_d. So
/// c_d is a weighted sum of the measured spectra; `c_d` is clamped at 0. Nothing where the lobe's shape is so
/// nearly Lambertian that the equations do not tell the two apart.
std::optional<std::vector<float>> diffuse_colour(const MeasuredBrdf& measured, const CellTable& table,
                                                 const FreeFresnelFit& fit);

}  // namespace spectrace
