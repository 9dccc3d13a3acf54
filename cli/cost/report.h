// SPDX-License-Identifier: Apache-2.0
// A cost study as files: index.html, cost.json, cost.csv, and each plot as .svg and .png.
#pragma once

#include <filesystem>

#include "cli/cost/measurement.h"

namespace spectrace::cli {

/// Makes the folder where it is absent; throws InputError where it cannot be.
void make_report_folder(const std::filesystem::path& folder);
void write_cost_report(const std::filesystem::path& folder, const CostStudy& study);

}  // namespace spectrace::cli
