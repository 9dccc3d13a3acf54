// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>

#include "separation/instruction_set.h"

namespace spectrace {

/// ln x for normal positive x, without branches, tables or divisions, so that loops over it vectorise:
/// |error| < 2e-7 max(1, |ln x|), far below the noise of any measurement. x = 2^e m with m in [√½, √2); then
/// ln(1 + f) = f - f²/2 + f³ p(f), p the polynomial through the seven Chebyshev nodes of that range.
SPECTRACE_KERNEL inline float fast_log(float x) {
  constexpr std::int32_t kSqrtHalf = 0x3f3504f3;  // bits of √½
  constexpr std::int32_t kMantissa = 0x007fffff;
  constexpr float kLn2 = 0.693147181F;
  const std::int32_t bits = std::bit_cast<std::int32_t>(x) - kSqrtHalf;
  const auto exponent = static_cast<float>(bits >> 23);
  const float f = std::bit_cast<float>((bits & kMantissa) + kSqrtHalf) - 1;
  float p = 0.0904878452F;
  p = p * f - 0.140308917F;
  p = p * f + 0.147038996F;
  p = p * f - 0.166027188F;
  p = p * f + 0.199842229F;
  p = p * f - 0.250007033F;
  p = p * f + 0.333334148F;
  const float square = f * f;
  return exponent * kLn2 + (f + (f * square * p - 0.5F * square));
}

/// e^x for |x| <= 2, relative error < 1e-5, and of the order of 1e-7 where |x| < 0.1.
SPECTRACE_KERNEL inline float fast_exp(float x) {
  const float y = x / 4;  // e^x = (e^y)^4, |y| <= ½: the series up to y⁶
  float e = 1 + y / 6;
  e = 1 + y / 5 * e;
  e = 1 + y / 4 * e;
  e = 1 + y / 3 * e;
  e = 1 + y / 2 * e;
  e = 1 + y * e;
  e *= e;
  return e * e;
}

/// e^x for |x| <= 12, relative error < 1.2e-5.
SPECTRACE_KERNEL inline float fast_wide_exp(float x) {
  float e = fast_exp(x / 8);
  e *= e;
  e *= e;
  return e * e;
}

}  // namespace spectrace
