// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "core/math/math.h"
#include "core/math/vec.h"

namespace spectrace {

/// The unit square onto the unit disk, areas in proportion and neighbours kept (Shirley & Chiu 1997). `u` in
/// [0, 1]².
inline Vec2 concentric_disk(Vec2 u) {
  const Float a = 2 * u.x - 1, b = 2 * u.y - 1;
  if (a == 0 && b == 0) return {0, 0};
  const bool wide = std::abs(a) > std::abs(b);
  const Float r = wide ? a : b;
  const Float phi = wide ? kPi / 4 * (b / a) : kPi / 2 - kPi / 4 * (a / b);
  return {r * std::cos(phi), r * std::sin(phi)};
}

}  // namespace spectrace
