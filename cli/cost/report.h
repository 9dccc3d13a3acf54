// SPDX-License-Identifier: Apache-2.0
// A cost study as files: index.html, cost.json, cost.csv, plots (.svg) and pictures (.png).
#pragma once

#include <filesystem>

#include "cli/cost/measurement.h"

namespace spectrace::cli {

/// The folder is made where it is absent.
void write_cost_report(const std::filesystem::path& folder, const CostStudy& study);

}  // namespace spectrace::cli
