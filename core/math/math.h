// SPDX-License-Identifier: Apache-2.0
// Scalars: constants and the one tested set of safe primitives.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/float.h"

namespace spectrace {

inline constexpr double kPi64 = std::numbers::pi;  ///< where double is worked in whatever Float is
inline constexpr Float kPi = Float(kPi64);
inline constexpr Float kInvPi = Float(std::numbers::inv_pi);

template <typename T>
constexpr T sqr(T x) {
  return x * x;
}
template <typename T>
constexpr T lerp(T a, T b, T t) {
  return (1 - t) * a + t * b;
}
/// x held within [low, high], NaN at low; by value, so that loops over lanes become vector code, which the
/// references of std::clamp prevent.
template <typename T>
constexpr T clamped(T x, T low, T high) {
  const T above = x > low ? x : low;
  return above < high ? above : high;
}
/// sqrt(max(x, 0)). Any x; NaN gives 0.
inline Float safe_sqrt(Float x) { return std::sqrt(x > 0 ? x : Float(0)); }
/// acos of x clamped to [-1, 1].
inline Float safe_acos(Float x) { return std::acos(std::clamp(x, Float(-1), Float(1))); }
/// a / b, or 0 where b == 0.
inline Float safe_div(Float a, Float b) { return b != 0 ? a / b : Float(0); }
constexpr Float degrees_to_radians(Float x) { return x * (kPi / 180); }
constexpr Float radians_to_degrees(Float x) { return x * (180 / kPi); }
/// Multiple importance sampling, power heuristic with exponent 2: Veach 1997, eq. 9.13. `pdf_a` > 0.
constexpr Float power_heuristic(Float pdf_a, Float pdf_b) {
  const Float r = pdf_b / pdf_a;  // the ratio cannot overflow into inf/inf as squares would
  return 1 / (1 + r * r);
}

}  // namespace spectrace
