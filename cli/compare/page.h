// SPDX-License-Identifier: Apache-2.0
// Comparisons as one HTML page that needs no network and no other file.
#pragma once

#include <span>
#include <string>

#include "cli/compare/comparison.h"

namespace spectrace::cli {

/// One test image: verdict, table of metrics and limits, and of each layer the reference and the test under a
/// slider, the difference and the error. To be made while the images are there.
std::string page_section(const NamedImage& reference, const NamedImage& test, const Comparison& result,
                         const CompareSettings& settings);
/// The page around the sections of all test images.
std::string comparison_page(std::span<const std::string> sections, const CompareSettings& settings);

}  // namespace spectrace::cli
