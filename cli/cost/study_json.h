// SPDX-License-Identifier: Apache-2.0
// A cost study as cost.json, there and back.
#pragma once

#include <filesystem>
#include <string>

#include "cli/cost/measurement.h"

namespace spectrace::cli {

[[nodiscard]] std::string json_of(const CostStudy& study);

/// Without pictures and points: what the fits say. Throws InputError where it is no cost.json, or one without
/// settings.
[[nodiscard]] CostStudy read_cost_study(const std::filesystem::path& file);

}  // namespace spectrace::cli
