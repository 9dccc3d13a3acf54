// SPDX-License-Identifier: Apache-2.0
#include "cli/cost/page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cli/cost/answers.h"
#include "core/base/version.h"
#include "core/image/error_map.h"

namespace spectrace::cli {

namespace {

constexpr const char* kStyle =
    "body{font:15px/1.5 sans-serif;max-width:1280px;margin:2em auto;padding:0 1em;color:#222}"
    "table{border-collapse:collapse;margin:1em 0}td,th{padding:.2em .8em;text-align:right;"
    "border-bottom:1px solid "
    "#ddd}td:first-child,th:first-child{text-align:left}svg{max-width:100%;height:auto}"
    ".views{display:flex;flex-wrap:wrap;gap:1em}figure{margin:0;flex:1 1 260px;max-width:360px}"
    "img{width:100%;display:block;image-rendering:pixelated;background:#222}figcaption{font-size:13px}"
    "[hidden]{display:none}#told{min-height:1.5em;font-weight:bold;position:sticky;top:0;background:#fff}"
    "code{background:#f2f2f2}";

// Shows the plot of the metric that is chosen, and tells what the pointer is on.
constexpr const char* kScript =
    "const metric=document.getElementById('metric'),told=document.getElementById('told');"
    "metric.addEventListener('change',()=>{for(const plot of document.querySelectorAll('[data-metric]'))"
    "plot.hidden=plot.dataset.metric!==metric.value});"
    "document.addEventListener('pointerover',event=>{const label=event.target.dataset?.label;"
    "if(label)told.textContent=label});";

constexpr int kLinePoints = 40;

std::string point_label(const CostRecord& record, const CostPoint& point) {
  return fmt::format(
      "{}, {} samples: {:.3g} s, relMSE {:.3g}, MAPE {:.3g} %, PSNR {:.2f} dB, CIEDE2000 {:.3g}",
      record.title, point.spp, point.seconds, point.metrics.rel_mse, 100 * point.metrics.mape,
      point.metrics.psnr_db, point.ciede2000);
}

std::string percent(double share) { return fmt::format("{:.3g}", 100 * share); }

/// Where it was measured: at the fewest samples.
double noise_of(const CostRecord& record) {
  return record.model.rel_mse(record.points.front().spp) - record.model.bias;
}

std::string reference_text(const CostStudy& study) {
  if (study.reference_spp == 0) return "Reference: a picture that was given, taken as free of noise.";
  return fmt::format(
      "Reference: the scene as it is, {} samples, {:.1f} s, seed of its own; its noise is a relMSE of "
      "{:.2g}, "
      "which all measured errors hold.",
      study.reference_spp, study.reference_seconds, study.reference_rel_mse);
}

std::string settings_table(const CostStudy& study) {
  const CostRecord& exact = study.records.front();
  std::string html =
      "<table><tr><th>setting</th><th>kernel</th><th>time a sample over exact</th><th>noise over "
      "exact</th><th>noise falls with exponent</th>"
      "<th>bias: root of relMSE [%]</th><th>most samples</th><th>s</th><th>relMSE</th><th>MAPE [%]</th>"
      "<th>PSNR [dB]</th><th>CIEDE2000</th><th>memory [MB]</th></tr>\n";
  for (const CostRecord& record : study.records) {
    const CostPoint& last = record.points.back();
    html += fmt::format(
        "<tr><td>{}</td><td>{}</td><td>{:.2f}</td><td>{:.2f}</td><td>{:.2f}</td><td>{}</td><td>{}</"
        "td><td>{:.2f}</td>"
        "<td>{:.3g}</td><td>{}</td><td>{:.2f}</td><td>{:.3g}</td><td>{:.0f}</td></tr>\n",
        escaped(record.title), escaped(record.kernel), record.model.per_sample / exact.model.per_sample,
        noise_of(record) / noise_of(exact), record.model.exponent, bias_text(record.bias), last.spp,
        last.seconds, last.metrics.rel_mse, percent(last.metrics.mape), last.metrics.psnr_db, last.ciede2000,
        double(record.peak_memory_bytes) * 1e-6);
  }
  return html + "</table>\n";
}

/// A column a lobe and band of the exact setting.
std::string parts_table(const CostStudy& study) {
  const std::vector<PartBias>& columns = study.records.front().parts;
  std::string html = "<table><tr><th>setting</th>";
  for (const PartBias& column : columns) html += fmt::format("<th>{}</th>", escaped(column.name));
  html += "</tr>\n";
  for (const CostRecord& record : study.records) {
    html += fmt::format("<tr><td>{}</td>", escaped(record.title));
    for (const PartBias& column : columns) {
      const auto part = std::find_if(record.parts.begin(), record.parts.end(),
                                     [&](const PartBias& p) { return p.name == column.name; });
      html += fmt::format("<td>{}</td>", part == record.parts.end() ? "" : bias_text(part->bias));
    }
    html += "</tr>\n";
  }
  return html + "</table>\n";
}

std::string answers_table(const CostStudy& study) {
  std::string html =
      "<table><tr><th>to reach a relMSE of</th><th>the cheapest setting is</th><th>with samples</th>"
      "<th>in seconds</th><th>exact needs</th></tr>\n";
  for (const double error : errors_to_ask_for(study)) {
    const std::optional<Answer> best = cheapest(study, error);
    if (!best) continue;
    const ErrorModel& exact = study.records.front().model;
    const std::optional<double> samples = exact.samples_for(error);
    html += fmt::format("<tr><td>{:g}</td><td>{}</td><td>{:.0f}</td><td>{:.3g}</td><td>{}</td></tr>\n", error,
                        escaped(best->record->title), std::ceil(best->samples), best->seconds,
                        samples ? fmt::format("{:.3g}", exact.seconds(*samples)) : "");
  }
  return html + "</table>\n";
}

std::string pictures(const CostStudy& study) {
  const double exposure = study.exposure;
  const auto figure = [](const Image& picture, const std::string& caption) {
    return fmt::format("<figure><img alt=\"{0}\" src=\"{1}\"><figcaption>{0}</figcaption></figure>\n",
                       escaped(caption), png_data_uri(picture));
  };
  const auto exposed = [&](Image picture) {
    for (float& value : picture.data) value *= static_cast<float>(exposure);
    return picture;
  };
  std::string html = "<div class=\"views\">\n" + figure(exposed(study.reference), "reference");
  for (const CostRecord& record : study.records) {
    html += figure(exposed(record.picture),
                   fmt::format("{}, {} samples", record.title, record.points.back().spp));
    html += figure(error_map(study.reference, record.picture), record.title + ", error");
  }
  return html + "</div>\n";
}

}  // namespace

LineChart error_chart(const CostStudy& study, const CostMetric& metric) {
  LineChart chart{.title = fmt::format("{} against time", metric.title),
                  .x_title = fmt::format("seconds of rendering, {} threads", study.threads),
                  .y_title = metric.title,
                  .curves = {}};
  for (const CostRecord& record : study.records) {
    Curve curve{.name = record.title, .points = {}, .line = {}};
    for (const CostPoint& point : record.points) {
      curve.points.push_back({point.seconds, metric.of(point), point_label(record, point)});
    }
    if (metric.is_fitted) {
      const double first = record.points.front().spp, ratio = record.points.back().spp / first;
      for (int i = 0; i <= kLinePoints; ++i) {
        const double samples = first * std::pow(ratio, double(i) / kLinePoints);
        curve.line.push_back(
            {record.model.seconds(samples), record.model.rel_mse(samples) + study.reference_rel_mse, ""});
      }
    } else {
      curve.line = curve.points;
    }
    chart.curves.push_back(std::move(curve));
  }
  return chart;
}

BarChart effects_chart(const CostStudy& study) {
  const double exact = study.records.front().model.per_sample;
  BarChart chart{
      .title = "what each effect takes of a sample's time", .unit = "% of exact", .groups = {}, .series = {}};
  BarSeries series{.name = "saved without", .values = {}};
  for (const CostRecord& record : study.records) {
    if (record.knob != "without" && record.knob != "path depth") continue;
    chart.groups.push_back(record.title);
    series.values.push_back(std::max(0.0, 100 * (1 - record.model.per_sample / exact)));
  }
  chart.series.push_back(std::move(series));
  return chart;
}

std::string cost_page(const CostStudy& study) {
  std::string html = fmt::format(
      "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>What accuracy costs: {0}</title>"
      "<style>{1}</style>\n<h1>What accuracy costs: {0}</h1>\n"
      "<p>{2} x {3} pixels on {4} threads, spectrace {5} ({6}). {7} Lines are fits: relMSE = noise &middot; "
      "samples^-exponent + bias + that of the reference, seconds = start + samples &middot; time a "
      "sample.</p>\n",
      escaped(study.scene), kStyle, study.width, study.height, study.threads, version(), commit(),
      reference_text(study));
  html += "<h2>Error against time</h2>\n<p><label>metric <select id=\"metric\">";
  for (const CostMetric& metric : kCostMetrics) {
    html += fmt::format("<option value=\"{}\">{}</option>", metric.id, metric.title);
  }
  html += "</select></label></p><p id=\"told\"></p>\n";
  for (const CostMetric& metric : kCostMetrics) {
    html += fmt::format("<div data-metric=\"{}\"{}>{}</div>\n", metric.id,
                        &metric == kCostMetrics.data() ? "" : " hidden", svg(error_chart(study, metric)));
  }
  html += "<h2>Which setting to take</h2>\n" + answers_table(study);
  html += "<p>Renders that no other beats in both: ";
  std::string separator;
  for (const FrontPoint& point : pareto_front(study)) {
    html += fmt::format("{}{} at {} samples", separator, escaped(point.record->title), point.point->spp);
    separator = ", ";
  }
  html += ".</p>\n<h2>All settings</h2>\n" + settings_table(study);
  html +=
      "<h2>Bias by lobe and wavelength</h2>\n<p>Roots of relMSE [%]. A measurement as it is has no lobes, "
      "all of it counts as specular: models move light "
      "from there to diffuse.</p>\n" +
      parts_table(study);
  html += "<h2>Seconds per effect</h2>\n" + svg(effects_chart(study));
  for (const std::string& reason : study.left_out) {
    html += fmt::format("<p>Left out: {}</p>\n", escaped(reason));
  }
  html += "<h2>Pictures</h2>\n" + pictures(study);
  return html + fmt::format("<script>{}</script></html>\n", kScript);
}

}  // namespace spectrace::cli
