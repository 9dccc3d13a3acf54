// SPDX-License-Identifier: Apache-2.0
#include "cli/cost/study_json.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/json.h"
#include "core/base/version.h"

namespace spectrace::cli {

namespace {

constexpr NumberRange kNotNegative{.min = 0};
constexpr int kMostPixels = 1 << 16;

CostRecord read_record(const JsonValue& json) {
  CostRecord record;
  record.knob = json.require("knob").string();
  record.name = json.require("name").string();
  record.title = title_of(record.knob, record.name);
  record.kernel = json.require("kernel").string();
  record.bias = {json.require("bias_rel_mse").number(0),
                 json.require("bias_rel_mse_standard_error").number(0, kNotNegative)};
  record.model.noise = json.require("noise_rel_mse_at_one_sample").number(0, kNotNegative);
  record.model.exponent = json.require("noise_exponent").number(1, kPositive);
  record.model.bias = std::max(0.0, record.bias.value);
  record.model.start = json.require("seconds_start").number(0, kNotNegative);
  record.model.per_sample = json.require("seconds_a_sample").number(0, kNotNegative);
  return record;
}

void write_texts(JsonWriter& json, const char* key, const std::vector<std::string>& texts) {
  json.key(key);
  json.begin_array();
  for (const std::string& text : texts) json.value(text);
  json.end_array();
}

}  // namespace

std::string json_of(const CostStudy& study) {
  JsonWriter json;
  json.begin_object();
  json.member("program", fmt::format("{} ({})", version(), commit()));
  json.member("scene", study.scene);
  json.member("content", study.content);
  json.member("width", study.width);
  json.member("height", study.height);
  json.member("scene_width", study.scene_width);
  json.member("scene_height", study.scene_height);
  json.member("threads", study.threads);
  json.member("reference_spp", study.reference_spp);
  json.member("reference_seconds", study.reference_seconds);
  json.member("reference_rel_mse", study.reference_rel_mse);
  json.member("epsilon", study.epsilon);
  json.key("settings");
  json.begin_array();
  for (const CostRecord& record : study.records) {
    json.begin_object();
    json.member("knob", record.knob);
    json.member("name", record.name);
    json.member("kernel", record.kernel);
    json.member("noise_rel_mse_at_one_sample", record.model.noise);
    json.member("noise_exponent", record.model.exponent);
    json.member("bias_rel_mse", record.bias.value);
    json.member("bias_rel_mse_standard_error", record.bias.standard_error);
    json.member("seconds_start", record.model.start);
    json.member("seconds_a_sample", record.model.per_sample);
    json.member("peak_memory_bytes", double(record.peak_memory_bytes));
    json.key("parts");
    json.begin_array();
    for (const PartBias& part : record.parts) {
      json.begin_object();
      json.member("name", part.name);
      json.member("bias_rel_mse", part.bias.value);
      json.member("bias_rel_mse_standard_error", part.bias.standard_error);
      json.end_object();
    }
    json.end_array();
    json.key("points");
    json.begin_array();
    for (const CostPoint& point : record.points) {
      json.begin_object();
      json.member("spp", point.spp);
      json.member("seconds", point.seconds);
      json.member("rel_mse", point.metrics.rel_mse);
      json.member("mape", point.metrics.mape);
      json.member("psnr_db", point.metrics.psnr_db);
      json.member("ssim", point.metrics.ssim);
      json.member("ciede2000", point.ciede2000);
      json.end_object();
    }
    json.end_array();
    json.end_object();
  }
  json.end_array();
  write_texts(json, "effects_used", study.effects.used);
  write_texts(json, "effects_skipped", study.effects.skipped);
  write_texts(json, "left_out", study.left_out);
  json.end_object();
  return json.text() + "\n";
}

CostStudy read_cost_study(const std::filesystem::path& file) {
  JsonDocument document = JsonDocument::load(file);
  const JsonValue root = document.root();
  CostStudy study;
  study.scene = root.require("scene").string();
  study.content = root.require("content").string();
  study.width = int(root.require("width").integer(1, 1, kMostPixels));
  study.height = int(root.require("height").integer(1, 1, kMostPixels));
  study.threads = int(root.require("threads").integer(1, 1, kMostPixels));
  study.reference_rel_mse = root.require("reference_rel_mse").number(0, kNotNegative);
  const JsonValue settings = root.require("settings");
  for (const JsonValue& setting : settings.elements()) study.records.push_back(read_record(setting));
  if (study.records.empty()) settings.error("expected at least one setting");
  document.throw_if_wrong();
  return study;
}

}  // namespace spectrace::cli
