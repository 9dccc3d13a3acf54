// SPDX-License-Identifier: Apache-2.0
#include "cli/reproduce/study_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/base/version.h"

namespace spectrace::cli {
namespace {

const StudyRow* find_row(const StudyRecord& record, std::string_view reference, std::string_view model) {
  const auto row = std::find_if(record.rows.begin(), record.rows.end(), [&](const StudyRow& r) {
    return r.reference == reference && r.model == model;
  });
  return row == record.rows.end() ? nullptr : &*row;
}

struct MeanField {
  const char* name;
  double ModelMean::*field;
};
constexpr std::array kMeanFields{
    MeanField{"psnr", &ModelMean::psnr_db},    MeanField{"ssim", &ModelMean::ssim},
    MeanField{"mape", &ModelMean::mape},       MeanField{"relmse", &ModelMean::rel_mse},
    MeanField{"seconds", &ModelMean::seconds}, MeanField{"megabytes", &ModelMean::megabytes}};

/// "fresnel over sun: +2.5 dB", where both are there.
void add_gain(std::vector<std::string>& lines, std::span<const ModelMean> means, std::string_view reference,
              std::string_view model, std::string_view over, std::string_view remark) {
  const ModelMean *a = find_mean(means, reference, model), *b = find_mean(means, reference, over);
  if (a == nullptr || b == nullptr) return;
  lines.push_back(fmt::format("reference {}: {} over {}: {:+.2f} dB{}", reference, model, over,
                              a->psnr_db - b->psnr_db, remark));
}

}  // namespace

std::vector<ModelMean> means_of(std::span<const StudyRecord> records) {
  std::vector<ModelMean> means;
  for (const StudyRecord& record : records) {
    for (const StudyRow& row : record.rows) {
      auto mean = std::find_if(means.begin(), means.end(), [&](const ModelMean& m) {
        return m.reference == row.reference && m.model == row.model;
      });
      if (mean == means.end())
        mean = means.insert(means.end(), {.reference = row.reference, .model = row.model});
      ++mean->materials;
      std::isinf(row.psnr_db) ? void(++mean->identical) : void(mean->psnr_db += row.psnr_db);
      mean->ssim += row.ssim;
      mean->mape += row.mape;
      mean->rel_mse += row.rel_mse;
      mean->seconds += row.seconds;
      mean->megabytes += double(row.bytes) * 1e-6;
      const StudyRow* const sun = find_row(record, row.reference, "sun");
      if (sun != nullptr && row.psnr_db > sun->psnr_db) ++mean->better_than_sun;
    }
  }
  for (ModelMean& mean : means) {
    for (const MeanField& f : kMeanFields) {
      mean.*f.field /= f.field == &ModelMean::psnr_db ? mean.materials - mean.identical : mean.materials;
    }
    if (mean.identical == mean.materials) mean.psnr_db = std::numeric_limits<double>::infinity();
  }
  std::stable_sort(means.begin(), means.end(), [](const ModelMean& a, const ModelMean& b) {
    const auto order = [](const std::string& r) { return r == "tabulated" ? 0 : r == "raw" ? 1 : 2; };
    return order(a.reference) < order(b.reference);
  });
  return means;
}

const ModelMean* find_mean(std::span<const ModelMean> means, std::string_view reference,
                           std::string_view model) {
  const auto mean = std::find_if(means.begin(), means.end(), [&](const ModelMean& m) {
    return m.reference == reference && m.model == model;
  });
  return mean == means.end() ? nullptr : &*mean;
}

std::string table_text(std::span<const ModelMean> means) {
  std::string text =
      fmt::format("{:<10} {:<14} {:>9} {:>9} {:>8} {:>9} {:>10} {:>8} {:>9}\n", "reference", "model",
                  "materials", "PSNR [dB]", "SSIM", "MAPE [%]", "relMSE", "MB", "beats sun");
  for (const ModelMean& m : means) {
    text += fmt::format("{:<10} {:<14} {:>9} {:>9.2f} {:>8.4f} {:>9.3f} {:>10.6f} {:>8.3f} {:>9}\n",
                        m.reference, m.model, m.materials, m.psnr_db, m.ssim, 100 * m.mape, m.rel_mse,
                        m.megabytes, m.better_than_sun);
  }
  return text;
}

std::vector<std::string> findings(std::span<const ModelMean> means) {
  std::vector<std::string> lines;
  add_gain(lines, means, "tabulated", "fresnel", "sun", " (paper: +2.12)");
  add_gain(lines, means, "tabulated", "diffraction", "sun", " (paper: +8.51)");
  add_gain(lines, means, "tabulated", "diffraction", "analytic", " (paper, its Fig. 8: +5.84)");
  add_gain(lines, means, "raw", "tabulated", "plain_table", ": what joining both orders of a pair gains");
  add_gain(lines, means, "raw", "oriented_table", "plain_table", ": what keeping both orders gains");
  add_gain(lines, means, "raw", "residual", "tabulated", ", the paper's ceiling");
  add_gain(lines, means, "raw", "residual", "oriented_table", ", its own ceiling");
  add_gain(lines, means, "truth", "residual_reciprocal", "diffraction", ": what its even terms gain");
  add_gain(lines, means, "truth", "residual", "diffraction", ": what they and the odd ones gain");
  if (const ModelMean* m = find_mean(means, "tabulated", "diffraction"); m != nullptr) {
    lines.push_back(fmt::format("reference tabulated: diffraction better than sun on {} of {} materials",
                                m->better_than_sun, m->materials));
  }
  return lines;
}

std::string csv_text(std::span<const StudyRecord> records) {
  std::string text = "material,reference,model,psnr,ssim,mape,relmse,seconds,bytes\n";
  for (const StudyRecord& record : records) {
    std::string name = record.material;  // a comma in a file's name would be a column
    std::replace(name.begin(), name.end(), ',', '_');
    for (const StudyRow& r : record.rows) {
      text += fmt::format("{},{},{},{:.4f},{:.6f},{:.6f},{:.8f},{:.4f},{}\n", name, r.reference, r.model,
                          r.psnr_db, r.ssim, r.mape, r.rel_mse, r.seconds, r.bytes);
    }
  }
  return text;
}

std::string json_text(std::span<const StudyRecord> records, std::span<const ModelMean> means,
                      const std::string& protocol) {
  JsonWriter json;
  json.begin_object();
  json.member("version", version());
  json.member("commit", commit());
  json.member("protocol", protocol);
  json.key("findings");
  json.begin_array();
  for (const std::string& line : findings(means)) json.value(line);
  json.end_array();
  json.key("means");
  json.begin_array();
  for (const ModelMean& m : means) {
    json.begin_object();
    json.member("reference", m.reference);
    json.member("model", m.model);
    json.member("materials", m.materials);
    json.member("better_than_sun", m.better_than_sun);
    json.member("identical", m.identical);
    for (const MeanField& f : kMeanFields) json.member(f.name, m.*f.field);
    json.end_object();
  }
  json.end_array();
  json.key("materials");
  json.begin_array();
  for (const StudyRecord& record : records) write_record(json, record);
  json.end_array();
  json.end_object();
  return json.text();
}

}  // namespace spectrace::cli
