// SPDX-License-Identifier: Apache-2.0
// From the figures of all materials to the paper's tables.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cli/reproduce/study_record.h"

namespace spectrace::cli {

/// A model's means over the materials, against one reference.
struct ModelMean {
  std::string reference, model;
  int materials = 0;
  int better_than_sun = 0;  ///< materials on which its PSNR is higher
  int identical = 0;        ///< materials whose pictures are the same to the last bit
  double psnr_db = 0;       ///< over the others
  double ssim = 0, mape = 0, rel_mse = 0, seconds = 0, megabytes = 0;
};

/// In the order the rows have: reference by reference, model by model.
std::vector<ModelMean> means_of(std::span<const StudyRecord> records);
/// The mean of that pair, if any material has it.
const ModelMean* find_mean(std::span<const ModelMean> means, std::string_view reference,
                           std::string_view model);

/// Tables 1 and 2 of the paper in one (its Table 2 is the row "analytic"), for each reference.
std::string table_text(std::span<const ModelMean> means);
/// What the paper claims and what was found, one line each: gains in PSNR, wins, the table's ceiling.
std::vector<std::string> findings(std::span<const ModelMean> means);

/// Columns: material, reference, model, psnr, ssim, mape, relmse, seconds, bytes.
std::string csv_text(std::span<const StudyRecord> records);
/// Everything: provenance, means, findings, records.
std::string json_text(std::span<const StudyRecord> records, std::span<const ModelMean> means,
                      const std::string& protocol);

}  // namespace spectrace::cli
