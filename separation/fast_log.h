// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>

namespace spectrace {

/// ln x for normal positive x, without branches or tables, so that loops over it vectorise: |error| < 2e-7
/// (max(1, |ln x|)), far below the noise of any measurement. x = 2^e m with m in [√½, √2); then ln m =
/// 2 artanh(s), s = (m - 1)/(m + 1), |s| < 0.172, by its series to s⁹ (truncated: 3e-10).
inline float fast_log(float x) {
  constexpr std::int32_t kSqrtHalf = 0x3f3504f3;  // bits of √½
  constexpr std::int32_t kMantissa = 0x007fffff;
  constexpr float kLn2 = 0.693147181F;
  const std::int32_t bits = std::bit_cast<std::int32_t>(x) - kSqrtHalf;
  const auto exponent = static_cast<float>(bits >> 23);
  const float m = std::bit_cast<float>((bits & kMantissa) + kSqrtHalf);
  const float s = (m - 1) / (m + 1), z = s * s;
  const float series = 1.0F / 3 + z * (1.0F / 5 + z * (1.0F / 7 + z * (1.0F / 9)));
  return exponent * kLn2 + 2 * (s + s * z * series);
}

}  // namespace spectrace
