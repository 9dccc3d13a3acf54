// SPDX-License-Identifier: Apache-2.0
// Differences of images as pictures.
#pragma once

#include "core/image/image.h"

namespace spectrace {

/// What the brightest colour of an error map stands for: a fifth of the reference.
inline constexpr double kErrorMapFull = 0.2;

/// |test - reference| / (|reference| + floor), averaged over the channels, from black over violet and orange
/// to pale yellow at `full` and above. R, G, B, linear. Both images: one size and channel count (checked).
Image error_map(const Image& reference, const Image& test, double full = kErrorMapFull, double floor = 1e-2);

/// The same colours from 0 at the left to `full` at the right, in the middle of an image of that size.
Image error_scale(int width, int height);

/// A signed picture around mid grey: grey + gain · value, R, G, B.
Image signed_map(const Image& rgb, double gain);

}  // namespace spectrace
