// SPDX-License-Identifier: Apache-2.0
#include "cli/cost/report.h"

#include <fmt/format.h>

#include <string>

#include "cli/cost/page.h"
#include "core/base/file.h"
#include "core/base/json.h"
#include "core/base/version.h"

namespace spectrace::cli {

namespace {

std::string json_of(const CostStudy& study) {
  JsonWriter json;
  json.begin_object();
  json.member("program", fmt::format("{} ({})", version(), commit()));
  json.member("scene", study.scene);
  json.member("width", study.width);
  json.member("height", study.height);
  json.member("threads", study.threads);
  json.member("reference_spp", study.reference_spp);
  json.member("reference_seconds", study.reference_seconds);
  json.member("reference_rel_mse", study.reference_rel_mse);
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
      json.end_object();
    }
    json.end_array();
    json.end_object();
  }
  json.end_array();
  json.key("left_out");
  json.begin_array();
  for (const std::string& reason : study.left_out) json.value(reason);
  json.end_array();
  json.end_object();
  return json.text() + "\n";
}

std::string csv_of(const CostStudy& study) {
  std::string csv = "knob,name,spp,seconds,rel_mse,mape,psnr_db,ssim,fitted_rel_mse,fitted_seconds\n";
  for (const CostRecord& record : study.records) {
    for (const CostPoint& point : record.points) {
      csv += fmt::format("{},{},{},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g}\n", record.knob,
                         record.name, point.spp, point.seconds, point.metrics.rel_mse, point.metrics.mape,
                         point.metrics.psnr_db, point.metrics.ssim, record.model.rel_mse(point.spp),
                         record.model.seconds(point.spp));
    }
  }
  return csv;
}

}  // namespace

void write_cost_report(const std::filesystem::path& folder, const CostStudy& study) {
  std::filesystem::create_directories(folder);
  write_file_atomically(folder / "cost.json", json_of(study));
  write_file_atomically(folder / "cost.csv", csv_of(study));
  for (const CostMetric& metric : kCostMetrics) {
    write_file_atomically(folder / fmt::format("{}.svg", metric.id), svg(error_chart(study, metric)));
  }
  write_file_atomically(folder / "effects.svg", svg(effects_chart(study)));
  write_file_atomically(folder / "index.html", cost_page(study));
}

}  // namespace spectrace::cli
