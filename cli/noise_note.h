// SPDX-License-Identifier: Apache-2.0
// Whether figures of two pictures hold the noise of their renders besides the difference in question.
#pragma once

#include <string>

#include "core/image/image.h"

namespace spectrace::cli {

/// Of two images: what in their headers says that they do not share their random numbers. Empty where
/// they do, where they are of one model, or where nothing is known (pictures of other programs).
std::string noise_note(const Metadata& of_reference, const Metadata& of_test);

}  // namespace spectrace::cli
