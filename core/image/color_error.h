// SPDX-License-Identifier: Apache-2.0
// How different two pictures look on a display.
#pragma once

#include "core/image/image.h"

namespace spectrace {

/// Mean of CIEDE2000 over the pixels of two pictures of R, G, B (linear sRGB), times `exposure` and clipped
/// to [0, 1] as a display does, against its white. Sizes and channel counts: the same, checked.
double mean_ciede2000(const Image& reference, const Image& test, double exposure);

}  // namespace spectrace
