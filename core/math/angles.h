// SPDX-License-Identifier: Apache-2.0
// Several arctangents at once.
#pragma once

#include <array>
#include <cstddef>
#include <numbers>

namespace spectrace {

/// Two doubles that processors work on together: of GCC and clang, on any processor.
using DoublePair = double __attribute__((vector_size(16)));

/// atan2(y, x) for finite y, x >= 0; 0 where both are 0. |error| < 1e-11, far below the rounding of
/// single-precision directions. Nothing branches: no processor can foresee which octant a direction lies in.
/// The angle is brought to within 22.5 degrees of 0, 45 or 90 degrees; from there it is z p(z²), z its
/// tangent and p the polynomial through the seven Chebyshev nodes of that range.
inline DoublePair first_quadrant_angles(DoublePair y, DoublePair x) {
  constexpr double kTanEighth = std::numbers::sqrt2 - 1;  // of 180 degrees
  constexpr double kTiny = 1e-300;                        // makes 0 / 0 0, and changes no other quotient
  constexpr DoublePair kZero{}, kDiagonal{std::numbers::pi / 4, std::numbers::pi / 4};
  const auto is_steep = y > x;
  const DoublePair small = is_steep ? x : y, large = is_steep ? y : x;
  const auto is_diagonal = small > kTanEighth * large;
  const DoublePair z =
      (small - (is_diagonal ? large : kZero)) / (large + (is_diagonal ? small : kZero) + kTiny);
  const DoublePair w = z * z, w2 = w * w;  // pairs of terms, for a short chain of dependent operations
  const DoublePair low = 0.999999999978399 - 0.3333333209761371 * w;
  const DoublePair middle = 0.19999883856762396 - 0.14281588776821702 * w;
  const DoublePair high = 0.11040489267496295 - 0.08456193077035462 * w + 0.047073484922127116 * w2;
  const DoublePair p = low + w2 * (middle + w2 * high);
  const DoublePair angle = (is_diagonal ? kDiagonal : kZero) + z * p;
  return is_steep ? std::numbers::pi / 2 - angle : angle;
}

}  // namespace spectrace
