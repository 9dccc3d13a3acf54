// SPDX-License-Identifier: Apache-2.0
// The report as one HTML page that needs no network and no other file.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "cli/report/bar_chart.h"
#include "cli/reproduce/study_summary.h"

namespace spectrace::cli {

/// PSNR a material against the table X, best last (the paper's Fig. 4).
BarChart psnr_chart(std::span<const StudyRecord> records);

/// `sheets`: the folder that holds MATERIAL.png of each finished record.
std::string study_page(std::span<const StudyRecord> records, std::span<const ModelMean> means,
                       const std::filesystem::path& sheets, const std::string& protocol);

}  // namespace spectrace::cli
