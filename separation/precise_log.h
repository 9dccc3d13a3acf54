// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>

#include "separation/instruction_set.h"

namespace spectrace {

/// ln x for normal positive x in double precision, |error| < 1e-15 max(1, |ln x|); without branches or
/// tables, so that loops over it vectorise. x = 2^e m with m in [√½, √2); then ln m = 2 artanh(s), s =
/// (m - 1)/(m + 1), |s| < 0.172, by its series up to s¹⁹ (truncated: 5e-17).
SPECTRACE_KERNEL inline double precise_log(double x) {
  constexpr std::uint64_t kOne = 0x3ff0000000000000, kSqrtHalf = 0x3fe6a09e667f3bcd;
  constexpr std::uint64_t kMantissa = 0x000fffffffffffff;
  // An integer below 2^52 in these bits is 2^52 more as a number: a conversion every instruction set has.
  constexpr std::uint64_t kTwo52 = 0x4330000000000000;
  constexpr double kTwo52AndBias = 4503599627370496.0 + 1023.0;
  constexpr double kLn2 = 0.693147180559945309;
  const std::uint64_t bits = std::bit_cast<std::uint64_t>(x) + (kOne - kSqrtHalf);
  const double exponent = std::bit_cast<double>((bits >> 52) | kTwo52) - kTwo52AndBias;
  const double m = std::bit_cast<double>((bits & kMantissa) + kSqrtHalf);
  const double s = (m - 1) / (m + 1), z = s * s;
  double series = 1.0 / 19;
  series = series * z + 1.0 / 17;
  series = series * z + 1.0 / 15;
  series = series * z + 1.0 / 13;
  series = series * z + 1.0 / 11;
  series = series * z + 1.0 / 9;
  series = series * z + 1.0 / 7;
  series = series * z + 1.0 / 5;
  series = series * z + 1.0 / 3;
  return exponent * kLn2 + 2 * (s + s * z * series);
}

}  // namespace spectrace
