// SPDX-License-Identifier: Apache-2.0
#include "cli/reproduce/study_record.h"

#include <cmath>
#include <limits>
#include <system_error>

namespace spectrace::cli {
namespace {

constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max();

struct CountField {
  const char* name;
  std::int64_t StudyRecord::*field;
};
constexpr CountField kCounts[]{{"wavelengths", &StudyRecord::wavelengths},
                               {"cells", &StudyRecord::cells},
                               {"measured", &StudyRecord::measured},
                               {"extrapolated", &StudyRecord::extrapolated},
                               {"invalid", &StudyRecord::invalid},
                               {"below_horizon", &StudyRecord::below_horizon},
                               {"negative_values", &StudyRecord::negative_values},
                               {"invalid_samples", &StudyRecord::invalid_samples}};
struct TextField {
  const char* name;
  std::string StudyRecord::*field;
};
constexpr TextField kTexts[]{{"material", &StudyRecord::material}, {"file", &StudyRecord::file},
                             {"key", &StudyRecord::key},           {"status", &StudyRecord::status},
                             {"problem", &StudyRecord::problem},   {"choice", &StudyRecord::choice}};
struct FigureField {
  const char* name;
  double StudyRow::*field;
};
constexpr FigureField kFigures[]{{"psnr", &StudyRow::psnr_db},
                                 {"ssim", &StudyRow::ssim},
                                 {"mape", &StudyRow::mape},
                                 {"relmse", &StudyRow::rel_mse},
                                 {"seconds", &StudyRow::seconds}};

StudyRow read_row(const JsonValue& json) {
  StudyRow row;
  row.reference = json.require("reference").string();
  row.model = json.require("model").string();
  for (const FigureField& f : kFigures) row.*f.field = json.require(f.name).number(0);
  if (json.require("identical").boolean(false)) row.psnr_db = std::numeric_limits<double>::infinity();
  row.bytes = json.require("bytes").integer(0, 0, kMost);
  return row;
}

}  // namespace

void write_record(JsonWriter& json, const StudyRecord& record) {
  json.begin_object();
  for (const TextField& f : kTexts) json.member(f.name, record.*f.field);
  for (const CountField& f : kCounts) json.member(f.name, record.*f.field);
  json.member("specular_share", record.specular_share);
  json.member("lambert_cost", record.lambert_cost);
  json.key("rows");
  json.begin_array();
  for (const StudyRow& row : record.rows) {
    json.begin_object();
    json.member("reference", row.reference);
    json.member("model", row.model);
    const bool identical = std::isinf(row.psnr_db);  // JSON has no infinity
    for (const FigureField& f : kFigures) {
      json.member(f.name, identical && f.field == &StudyRow::psnr_db ? 0 : row.*f.field);
    }
    json.member("identical", identical);
    json.member("bytes", row.bytes);
    json.end_object();
  }
  json.end_array();
  json.end_object();
}

std::optional<StudyRecord> read_record(const std::filesystem::path& file, std::string_view key) {
  std::error_code absent;
  if (!std::filesystem::exists(file, absent)) return std::nullopt;
  try {
    JsonDocument document = JsonDocument::load(file);
    const JsonValue root = document.root();
    StudyRecord record;
    for (const TextField& f : kTexts) record.*f.field = root.require(f.name).string();
    for (const CountField& f : kCounts) record.*f.field = root.require(f.name).integer(0, 0, kMost);
    record.specular_share = root.require("specular_share").number(0);
    record.lambert_cost = root.require("lambert_cost").number(0);
    for (const JsonValue& row : root.require("rows").elements()) record.rows.push_back(read_row(row));
    if (!document.diagnostics().empty() || record.key != key) return std::nullopt;
    return record;
  } catch (const InputError&) {
    return std::nullopt;  // cut short by a crash: as if it were not there
  }
}

}  // namespace spectrace::cli
