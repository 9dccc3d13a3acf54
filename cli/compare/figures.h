// SPDX-License-Identifier: Apache-2.0
// Comparisons as tables for people and as JSON for programs.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "cli/compare/comparison.h"

namespace spectrace::cli {

/// What the figures mean: data range, windows, constants; one line each.
std::vector<std::string> conventions(const CompareSettings& settings);
/// "beauty z-test: ...": its figures, and the verdict in front.
std::string z_test_line(const LayerResult& layer, const ZTestOptions& options);

/// To standard output. One test: a row a layer. Several: of each test the layers that are named.
void print_comparisons(std::span<const Comparison> results, const CompareSettings& settings);
/// One test: its object. Several: an array of them.
std::string json_text(std::span<const Comparison> results, const CompareSettings& settings);

}  // namespace spectrace::cli
