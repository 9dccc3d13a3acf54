// SPDX-License-Identifier: Apache-2.0
// What `spectrace reproduce` keeps of one material: figures, and where its pictures are.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/json.h"

namespace spectrace::cli {

/// One picture against one reference.
struct StudyRow {
  std::string reference;  ///< "tabulated", "raw", "truth"
  /// "analytic", "sun", "fresnel", "diffraction"; also "residual" and "residual_reciprocal" (without its odd
  /// terms), and against raw the tables "tabulated" (X), "oriented_table" (X with what is not reciprocal) and
  /// "plain_table"; against the truth also "diffuse" and "specular", the components of the diffraction model.
  std::string model;
  double psnr_db = 0;  ///< infinite where the pictures are the same to the last bit
  double ssim = 0, mape = 0, rel_mse = 0;
  double seconds =
      0;  ///< from the file on disk to that description (sun, fresnel, diffraction fitted together)
  std::int64_t bytes = 0;  ///< of that description: a compact `.sep`, or a table in memory
};

struct StudyRecord {
  std::string material, file, key;  ///< key: of the file's bytes and all options that figures depend on
  std::string status = "done";      ///< "unusable": the fit; "bad": the file
  std::string problem;              ///< why it is not done
  std::int64_t wavelengths = 0;
  std::string choice;  ///< what --model auto takes, and why
  double specular_share = 0, lambert_cost = 0;
  std::int64_t cells = 0, measured = 0, extrapolated = 0, invalid = 0, below_horizon = 0, negative_values = 0,
               invalid_samples = 0;
  std::vector<StudyRow> rows;
};

void write_record(JsonWriter& json, const StudyRecord& record);
/// The record in a file, if it is there, whole and of that key; else nothing: it is then made anew.
std::optional<StudyRecord> read_record(const std::filesystem::path& file, std::string_view key);

}  // namespace spectrace::cli
