// SPDX-License-Identifier: Apache-2.0
// How wide what one sample of a pixel stands for is, along its path (ADR 0013).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/base/float.h"

namespace spectrace {

/// Amanatides 1984, "Ray Tracing with Cones". Flat mirrors and windows leave a cone as it is; no other
/// surface changes it here either.
struct RayCone {
  Float width = 0;   ///< diameter at its beginning
  Float spread = 0;  ///< growth of it per length

  [[nodiscard]] RayCone at(Float distance) const { return {width + spread * distance, spread}; }
  friend RayCone operator*(const RayCone& cone, Float s) { return {cone.width * s, cone.spread * s}; }
};

/// Of a pixel's side, what its sample `i` stands for. i + 1 samples lie 1 / sqrt(i + 1) apart: more than that
/// would blur what they resolve. A function of the sample alone, so that samples may be split between runs.
/// Never below 1/8, where finer texels would be read for nothing that is seen.
inline Float share_of_pixel(std::uint32_t sample) {
  return std::max(Float(1) / std::sqrt(Float(sample) + 1), Float(0.125));
}

}  // namespace spectrace
