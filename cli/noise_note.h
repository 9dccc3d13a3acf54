// SPDX-License-Identifier: Apache-2.0
// Whether figures of two pictures hold the noise of their renders besides the difference in question.
#pragma once

#include <string>

namespace spectrace::cli {

/// Of two image files: what in their headers says that they do not share their random numbers. Empty where
/// they do, where they are of one model, or where nothing is known (pictures of other programs).
std::string noise_note(const std::string& reference, const std::string& test);

}  // namespace spectrace::cli
