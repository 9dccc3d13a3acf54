// SPDX-License-Identifier: Apache-2.0
// The CIE 1931 2° observer, the illuminants D65 and A, and the way from spectra to XYZ and linear sRGB.
#pragma once

#include <array>

#include "core/spectra/spectrum.h"

namespace spectrace {

/// x̄, ȳ, z̄ at a wavelength [nm]; linear between the tabulated nanometres, 0 outside 360-830 nm.
Xyz cie_xyz_bar(double lambda_nm);
/// ∫ ȳ dλ [nm] of that table (106.857): the normalisation of every XYZ here.
double cie_y_integral();

/// Relative spectral power, 1 at 560 nm. D65 is the CIE table (5 nm, linear; its end values hold outside
/// 300-830 nm), A the CIE formula.
double illuminant_d65(double lambda_nm);
double illuminant_a(double lambda_nm);
/// Y of illuminant_d65: D65 divided by it gives a perfect reflector luminance 1.
double d65_luminance();

/// ∫ L(λ) (x̄, ȳ, z̄) dλ / ∫ ȳ dλ over `range`, by 1 nm steps: a constant spectrum 1 has Y = 1.
Xyz spectrum_to_xyz(const Spectrum& emission, WavelengthRange range = {});
/// As seen under an illuminant, white (reflectance 1) having Y = 1.
Xyz reflectance_to_xyz(const Spectrum& reflectance, double (*illuminant)(double) = illuminant_d65);

/// Linear transforms between XYZ and linear sRGB: the primaries of IEC 61966-2-1 and, as white, D65 as
/// integrated here, so that a perfect reflector is exactly (1, 1, 1); within 3e-4 of the standard's rounded
/// matrix. Inverses of each other to rounding.
Rgb xyz_to_rgb(const Xyz& xyz);
Xyz rgb_to_xyz(const Rgb& rgb);
/// CIELAB (CIE 15): L* of `white` is 100; any scale, the same for both.
Xyz xyz_to_lab(const Xyz& xyz, const Xyz& white);
/// The function of CIELAB, and its slope: a cube root above its toe, a line below.
double lab_curve(double t);
double lab_slope(double t);
/// The sRGB transfer curve for display, [0, 1] to [0, 1].
double srgb_encode(double linear);
double srgb_decode(double encoded);

}  // namespace spectrace
