// SPDX-License-Identifier: Apache-2.0
#include "cli/reproduce/study_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "cli/report/canvas.h"
#include "core/base/version.h"
#include "core/image/image.h"

namespace spectrace::cli {
namespace {

constexpr const char* kStyle =
    "body{font:15px/1.5 sans-serif;max-width:1280px;margin:2em auto;padding:0 1em;color:#222}"
    "table{border-collapse:collapse;margin:1em 0}td,th{padding:.2em .8em;text-align:right;"
    "border-bottom:1px solid #ddd}td:first-child,td:nth-child(2),th:first-child,th:nth-child(2)"
    "{text-align:left}img{width:100%;height:auto;background:#222}svg{max-width:100%;height:auto}"
    "summary{cursor:pointer;font-weight:bold}.bad{color:#a00}code{background:#f2f2f2}";

double psnr_of(const StudyRecord& record, std::string_view model) {
  for (const StudyRow& row : record.rows) {
    if (row.reference == "tabulated" && row.model == model) return row.psnr_db;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

std::string means_table(std::span<const ModelMean> means) {
  std::string html =
      "<table><tr><th>reference</th><th>model</th><th>materials</th><th>PSNR [dB]</th><th>SSIM</th>"
      "<th>MAPE [%]</th><th>relMSE</th><th>MB</th><th>s</th><th>better than sun on</th></tr>\n";
  for (const ModelMean& m : means) {
    html += fmt::format(
        "<tr><td>{}</td><td>{}</td><td>{}</td><td>{:.2f}</td><td>{:.4f}</td><td>{:.3f}</td><td>{:.6f}</td>"
        "<td>{:.3f}</td><td>{:.2f}</td><td>{}</td></tr>\n",
        m.reference, m.model, m.materials, m.psnr_db, m.ssim, 100 * m.mape, m.rel_mse, m.megabytes, m.seconds,
        m.better_than_sun);
  }
  return html + "</table>\n";
}

std::string material_section(const StudyRecord& record, const std::filesystem::path& sheets) {
  std::string html = fmt::format("<details open><summary>{}</summary>\n<p>", escaped(record.material));
  html += fmt::format(
      "{} wavelengths; of {} cells {} measured, {} extrapolated, {} invalid, {} below the horizon; {} "
      "negative values clamped. {:.1f} % of the light is specular; an exact Lambert lobe has {:.2f} % too "
      "much. {} invalid samples.<br>Cheapest model within tolerance: {}.</p>\n",
      record.wavelengths, record.cells, record.measured, record.extrapolated, record.invalid,
      record.below_horizon, record.negative_values, 100 * record.specular_share, 100 * record.lambert_cost,
      record.invalid_samples, escaped(record.choice));
  const Image sheet = read_image(sheets / (record.material + ".png"));
  return html + fmt::format("<img loading=\"lazy\" alt=\"{}\" src=\"{}\"></details>\n",
                            escaped(record.material), jpeg_data_uri(sheet));
}

}  // namespace

BarChart psnr_chart(std::span<const StudyRecord> records) {
  std::vector<const StudyRecord*> done;
  for (const StudyRecord& r : records) {
    if (r.status == "done") done.push_back(&r);
  }
  std::stable_sort(done.begin(), done.end(), [](const StudyRecord* a, const StudyRecord* b) {
    return psnr_of(*a, "diffraction") < psnr_of(*b, "diffraction");
  });
  BarChart chart{.title = "PSNR against the table X", .unit = "dB", .groups = {}, .series = {}};
  for (const StudyRecord* r : done) chart.groups.push_back(r->material);
  for (const char* model : {"analytic", "sun", "fresnel", "diffraction"}) {
    BarSeries series{.name = model, .values = {}};
    for (const StudyRecord* r : done) series.values.push_back(psnr_of(*r, model));
    chart.series.push_back(std::move(series));
  }
  return chart;
}

std::string study_page(std::span<const StudyRecord> records, std::span<const ModelMean> means,
                       const std::filesystem::path& sheets, const std::string& protocol) {
  std::string html = fmt::format(
      "<!doctype html>\n<html lang=\"en\"><meta charset=\"utf-8\"><title>Separation of measured "
      "BRDFs</title><style>{}</style>\n<h1>Separation of measured BRDFs</h1>\n<p>{}</p>\n<p>Made by "
      "spectrace "
      "{}, commit <code>{}</code>. <em>tabulated</em>: against the picture rendered from the table X, the "
      "paper's reference; <em>raw</em>: against the measurement itself; <em>truth</em>: against the material "
      "that was measured, where it is known.</p>\n",
      kStyle, escaped(protocol), version(), commit());
  for (const StudyRecord& r : records) {
    if (r.status != "done")
      html += fmt::format("<p class=\"bad\">{}: {}</p>\n", escaped(r.file), escaped(r.problem));
  }
  html += "<h2>Tables 1 and 2</h2>\n" + means_table(means) + "<ul>\n";
  for (const std::string& line : findings(means)) html += "<li>" + escaped(line) + "</li>\n";
  html += "</ul>\n<h2>Figure 4</h2>\n" + svg(psnr_chart(records)) + "<h2>Materials</h2>\n";
  for (const StudyRecord& r : records) {
    if (r.status == "done") html += material_section(r, sheets);
  }
  return html + "</html>\n";
}

}  // namespace spectrace::cli
