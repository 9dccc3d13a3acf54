// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/image/image.h"

namespace spectrace::cli {

/// The factor that brings the 98th percentile of a picture's positive values to white; 1 where none is.
double exposure_of(const Image& rgb);

}  // namespace spectrace::cli
