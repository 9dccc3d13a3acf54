// SPDX-License-Identifier: Apache-2.0
// The illuminants of the CIE, by name.
#pragma once

#include <initializer_list>
#include <string_view>

#include "core/spectra/spectrum.h"

namespace spectrace {

inline const std::initializer_list<std::string_view> kIlluminantNames = {"D65", "D50", "D55", "D75", "A",
                                                                         "E",   "F2",  "F7",  "F11"};

/// One of kIlluminantNames. D.., A and E: relative power, 1 at 560 nm. Fluorescent lamps, which send out
/// little there, have the luminance of E instead.
[[nodiscard]] Spectrum named_illuminant(std::string_view name);

/// Daylight of a nominal temperature, 4000 to 25000 K, from its components S0, S1, S2 (CIE 15:2004, sec. 3.1
/// and table T.2). 1 at 560 nm.
[[nodiscard]] TabulatedSpectrum daylight(double nominal_kelvin);

}  // namespace spectrace
