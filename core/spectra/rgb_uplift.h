// SPDX-License-Identifier: Apache-2.0
// RGB to spectra: Jakob & Hanika's sigmoids for reflectance and emission, a linear map for measured tables.
#pragma once

#include "core/spectra/spectrum.h"

namespace spectrace {

/// The sigmoid whose colour under D65 is `rgb` (linear sRGB, each in [0, 1]; clamped). Solved by Gauss-Newton
/// in double to 1e-6 in CIELAB; outside the reachable gamut the nearest the solver finds.
SigmoidSpectrum uplift_reflectance(const Rgb& rgb);
/// The same from a table built with the program, for texels: within 2e-3 of `rgb` on the round trip.
SigmoidSpectrum uplift_reflectance_fast(const Rgb& rgb);
/// Emission: negative channels are clamped to 0; scale = 2 · max(rgb) leaves the sigmoid at most 1/2, far
/// from its saturated ends.
RgbIlluminantSpectrum uplift_emission(const Rgb& rgb);
RgbIlluminantSpectrum uplift_emission_fast(const Rgb& rgb);
/// What light is multiplied by: a scaled sigmoid without an illuminant; any channels >= 0, white is 1.
SigmoidSpectrum uplift_factor(const Rgb& rgb);

/// Three fixed smooth non-negative spectra r(λ), g(λ), b(λ) that sum to 1 at every wavelength and whose
/// colours under D65 are the three sRGB primaries. rgb -> rgb[0] r + rgb[1] g + rgb[2] b is linear and
/// unbounded: it commutes with interpolation and separation of RGB tables.
std::array<Float, 3> rgb_basis(Float lambda_nm);
/// The same at all wavelengths of a path.
std::array<SampledSpectrum, 3> rgb_basis(const SampledWavelengths& lambda);

}  // namespace spectrace
