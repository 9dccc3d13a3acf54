// SPDX-License-Identifier: Apache-2.0
#include "cli/cost/page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cli/cost/answers.h"
#include "cli/cost/plots.h"
#include "cli/report/canvas.h"
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

std::string size_text(const CostStudy& study) {
  const bool is_whole = study.width == study.scene_width && study.height == study.scene_height;
  return is_whole ? fmt::format("{} x {} pixels", study.width, study.height)
                  : fmt::format("{} x {} pixels, for the budget had no time for the scene's {} x {},",
                                study.width, study.height, study.scene_width, study.scene_height);
}

/// What the fits can be held against: independent samples obey a law, stratified ones should be better.
std::string noise_text(const CostStudy& study) {
  const SamplerPair samplers = samplers_of(study);
  if (samplers.independent == nullptr) return "";
  const ErrorModel &own = samplers.stratified->model, &other = samplers.independent->model;
  const double most =
      std::min(samplers.stratified->points.back().spp, samplers.independent->points.back().spp);
  return fmt::format(
      "<p>Of independent samples the noise part must fall as 1/time: its slope here is -{:.2f}. "
      "Owen-scrambled "
      "Sobol' points, stratified within each pixel, have -{:.2f}, and at {:.0f} samples {:.2f} times as much "
      "noise as independent ones: that is why \"exact\" and all other settings fall faster than "
      "1/time.</p>\n",
      other.exponent, own.exponent, most,
      (own.rel_mse(most) - own.bias) / (other.rel_mse(most) - other.bias));
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

std::string effects_list(const char* title, const std::vector<std::string>& effects) {
  std::string html = fmt::format("<p>{}:</p><ul>\n", title);
  for (const std::string& effect : effects) html += fmt::format("<li>{}</li>\n", escaped(effect));
  return html + "</ul>\n";
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

std::string cost_page(const CostStudy& study) {
  std::string html = fmt::format(
      "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>What accuracy costs: {0}</title>"
      "<style>{1}</style>\n<h1>What accuracy costs: {0}</h1>\n"
      "<p>{2} on {3} threads, spectrace {4} ({5}). {6} Lines are fits: relMSE = noise &middot; "
      "samples^-exponent + bias + that of the reference, seconds = start + samples &middot; time a "
      "sample.</p>\n",
      escaped(study.scene), kStyle, size_text(study), study.threads, version(), commit(),
      reference_text(study));
  html += "<h2>Error against time</h2>\n<p><label>metric <select id=\"metric\">";
  for (const CostMetric& metric : kCostMetrics) {
    html += fmt::format("<option value=\"{}\">{}</option>", metric.id, metric.title);
  }
  html += "</select></label></p><p id=\"told\"></p>\n";
  const std::vector<CostPlot> plots = plots_of(study);
  for (std::size_t i = 0; i < kCostMetrics.size(); ++i) {
    html += fmt::format("<div data-metric=\"{}\"{}>{}</div>\n", plots[i].id, i == 0 ? "" : " hidden",
                        plots[i].to_svg());
  }
  html += "<h2>Which setting to take</h2>\n" + answers_table(study);
  html += svg(pareto_chart(study)) + "<h2>Noise</h2>\n" + noise_text(study) + svg(noise_chart(study));
  html += "<h2>All settings</h2>\n" + settings_table(study);
  html +=
      "<h2>Bias by lobe and wavelength</h2>\n<p>Roots of relMSE [%]. A measurement as it is has no lobes, "
      "all of it counts as specular: models move light "
      "from there to diffuse.</p>\n" +
      parts_table(study);
  html += "<h2>Seconds per effect</h2>\n" + svg(effects_chart(study));
  html += effects_list("Simulated", study.effects.used);
  html += effects_list("Not simulated", study.effects.skipped);
  for (const std::string& reason : study.left_out) {
    html += fmt::format("<p>Left out: {}</p>\n", escaped(reason));
  }
  html += "<h2>Pictures</h2>\n" + pictures(study);
  return html + fmt::format("<script>{}</script></html>\n", kScript);
}

}  // namespace spectrace::cli
