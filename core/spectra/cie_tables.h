// SPDX-License-Identifier: Apache-2.0
// The figures of the CIE, as published; core/spectra/color.h is how the program reads them.
#pragma once

#include <array>
#include <cstddef>

namespace spectrace {

/// Colour matching functions of the 1931 2° observer, 360 nm to 830 nm by 1 nm (CIE 15:2004, ISO/CIE
/// 11664-1).
inline constexpr int kCieMinNm = 360, kCieMaxNm = 830;
inline constexpr std::size_t kCieSamples = 471;
extern const std::array<double, kCieSamples> kCieXBar, kCieYBar, kCieZBar;

/// Relative spectral power of D65, 100 at 560 nm, 300 nm to 830 nm by 5 nm (CIE 15:2004, ISO/CIE 11664-2).
inline constexpr int kD65MinNm = 300, kD65StepNm = 5;
inline constexpr std::size_t kD65Samples = 107;
extern const std::array<double, kD65Samples> kD65;

}  // namespace spectrace
