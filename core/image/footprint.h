// SPDX-License-Identifier: Apache-2.0
// The part of a texture that one lookup stands for.
#pragma once

#include "core/math/vec.h"

namespace spectrace {

/// The two diameters of an ellipse in texture coordinates, the longer one first. Zero: a point, where
/// textures are bilinear between their finest texels (ADR 0013).
struct Footprint {
  Vec2 major{}, minor{};
};

inline constexpr Footprint kPointFootprint{};
/// All of an image.
inline constexpr Footprint kWholeFootprint{.major = {1, 0}, .minor = {0, 1}};

/// How many times as long as wide a footprint may be: what lookups along it cost is bounded so. Those who
/// make footprints shorten them; what is cut off is left to the samples of the pixel.
inline constexpr Float kLongestFootprint = 16;

}  // namespace spectrace
