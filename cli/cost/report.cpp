// SPDX-License-Identifier: Apache-2.0
#include "cli/cost/report.h"

#include <fmt/format.h>

#include <string>
#include <system_error>

#include "cli/cost/page.h"
#include "cli/cost/plots.h"
#include "cli/cost/study_json.h"
#include "core/base/error.h"
#include "core/base/file.h"

namespace spectrace::cli {

namespace {

std::string csv_of(const CostStudy& study) {
  std::string csv =
      "knob,name,spp,seconds,rel_mse,mape,psnr_db,ssim,ciede2000,fitted_rel_mse,fitted_seconds\n";
  for (const CostRecord& record : study.records) {
    for (const CostPoint& point : record.points) {
      csv += fmt::format("{},{},{},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g}\n", record.knob,
                         record.name, point.spp, point.seconds, point.metrics.rel_mse, point.metrics.mape,
                         point.metrics.psnr_db, point.metrics.ssim, point.ciede2000,
                         record.model.rel_mse(point.spp), record.model.seconds(point.spp));
    }
  }
  return csv;
}

}  // namespace

void make_report_folder(const std::filesystem::path& folder) {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed) throw InputError(folder.string(), "", "cannot make this folder: " + failed.message());
}

void write_cost_report(const std::filesystem::path& folder, const CostStudy& study) {
  write_file_atomically(folder / "cost.json", json_of(study));
  write_file_atomically(folder / "cost.csv", csv_of(study));
  for (const CostPlot& plot : plots_of(study)) {
    write_file_atomically(folder / (plot.id + ".svg"), plot.to_svg());
    write_png(folder / (plot.id + ".png"), plot.to_picture());
  }
  write_file_atomically(folder / "index.html", cost_page(study));
}

}  // namespace spectrace::cli
