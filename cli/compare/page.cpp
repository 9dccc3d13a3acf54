// SPDX-License-Identifier: Apache-2.0
#include "cli/compare/page.h"

#include <fmt/format.h>

#include "cli/compare/figures.h"
#include "cli/compare/pictures.h"
#include "cli/report/canvas.h"
#include "core/base/version.h"

namespace spectrace::cli {

namespace {

// Two images in one place: the upper one is cut off at --cut, which the slider moves.
constexpr const char* kStyle =
    "body{font:15px/1.5 sans-serif;max-width:1280px;margin:2em auto;padding:0 1em;color:#222}"
    "table{border-collapse:collapse;margin:1em 0}td,th{padding:.2em .8em;text-align:right;"
    "border-bottom:1px solid #ddd}td:first-child,th:first-child{text-align:left}"
    ".pass{color:#060}.fail{color:#a00;font-weight:bold}code{background:#f2f2f2}"
    ".views{display:flex;flex-wrap:wrap;gap:1em}figure{margin:0;flex:1 1 380px;max-width:100%}"
    "img{width:100%;display:block;image-rendering:pixelated;background:#222}"
    ".ab{position:relative;--cut:50%}.ab img+img{position:absolute;inset:0;clip-path:inset(0 0 0 var(--cut))}"
    ".ab::after{content:'';position:absolute;inset:0 auto 0 var(--cut);border-left:1px solid #fff}"
    "input{width:100%;margin:0}";

// Beyond this PNG makes pages that browsers open slowly; JPEG is then a tenth of it.
constexpr std::size_t kLosslessPixels = std::size_t(1) << 20;

std::string data_uri(const Image& picture) {
  const bool is_small = std::size_t(picture.width) * std::size_t(picture.height) <= kLosslessPixels;
  return is_small ? png_data_uri(picture) : jpeg_data_uri(picture);
}

const char* verdict_class(bool passes) { return passes ? "pass" : "fail"; }

/// The limits of one layer and metric, as they stand in its cell.
std::string limits_of(const Comparison& result, const std::string& layer, const MetricName& metric) {
  std::string html;
  for (const LimitResult& l : result.limits) {
    if (l.layer != layer || l.limit.metric != &metric) continue;
    html += fmt::format("<br><span class=\"{}\">{} {} {:g}</span>", verdict_class(l.holds),
                        l.holds ? "pass" : "FAIL", l.limit.is_max ? "&le;" : "&ge;", l.limit.value);
  }
  return html;
}

std::string metrics_table(const Comparison& result) {
  std::string html = "<table><tr><th>layer</th>";
  for (const MetricName& metric : kMetricNames) html += fmt::format("<th>{}</th>", metric.name);
  html += "<th>data range</th></tr>\n";
  for (const LayerResult& layer : result.layers) {
    html += fmt::format("<tr><td>{}</td>", escaped(layer.name()));
    for (const MetricName& metric : kMetricNames) {
      html += fmt::format("<td>{:.5g}{}</td>", layer.metrics.together.*metric.field,
                          limits_of(result, layer.name(), metric));
    }
    html += fmt::format("<td>{:.5g}</td></tr>\n", layer.metrics.together.data_range);
  }
  return html + "</table>\n";
}

std::string figure(const Image& picture, const std::string& caption) {
  return fmt::format("<figure><img alt=\"{0}\" src=\"{1}\"><figcaption>{0}</figcaption></figure>\n", caption,
                     data_uri(picture));
}

std::string layer_views(const LayerPictures& pictures) {
  std::string html = fmt::format(
      "<h3>{}</h3>\n<div class=\"views\">\n<figure><div class=\"ab\"><img alt=\"reference\" "
      "src=\"{}\"><img alt=\"test\" src=\"{}\"></div><input type=\"range\" min=\"0\" max=\"100\" "
      "value=\"50\" "
      "step=\"0.1\" aria-label=\"reference or test\" "
      "oninput=\"this.previousElementSibling.style.setProperty('--cut',this.value+'%')\">"
      "<figcaption>left of the line the reference, right of it the test; times "
      "{:.3g}</figcaption></figure>\n",
      escaped(pictures.layer), data_uri(pictures.reference), data_uri(pictures.test), pictures.exposure);
  html +=
      figure(pictures.difference, fmt::format("test - reference around grey, times {:.3g}", pictures.gain));
  html += figure(pictures.error, "relative error, from black (0) to pale yellow (20 % and above)");
  if (pictures.z) html += figure(*pictures.z, "z around grey; black: below minus the threshold");
  return html + "</div>\n";
}

}  // namespace

std::string page_section(const NamedImage& reference, const NamedImage& test, const Comparison& result,
                         const CompareSettings& settings) {
  std::string html = fmt::format(
      "<h2>{0}: <span class=\"{1}\">{2}</span></h2>\n<p>reference <code>{3}</code>, test <code>{0}</code>, "
      "{4} x "
      "{5} pixels</p>\n",
      escaped(result.test), verdict_class(result.passes()), result.passes() ? "pass" : "FAIL",
      escaped(result.reference), result.width, result.height);
  for (const std::string& line : result.non_finite) {
    html += fmt::format("<p class=\"fail\">FAIL: {}</p>\n", escaped(line));
  }
  if (!result.note.empty()) html += fmt::format("<p>note: {}</p>\n", escaped(result.note));
  if (!result.not_compared.empty()) {
    html += fmt::format("<p>not compared: {}</p>\n",
                        escaped(fmt::format("{}", fmt::join(result.not_compared, ", "))));
  }
  html += metrics_table(result);
  for (const LayerResult& layer : result.layers) {
    if (!layer.z_test) continue;
    html += fmt::format("<p class=\"{}\">{}</p>\n", verdict_class(layer.z_test->result.passes),
                        escaped(z_test_line(layer, *settings.z_test)));
  }
  for (const LayerResult& layer : result.layers) html += layer_views(make_pictures(reference, test, layer));
  return html;
}

std::string comparison_page(std::span<const std::string> sections, const CompareSettings& settings) {
  std::string html = fmt::format(
      "<!doctype html>\n<html lang=\"en\"><meta charset=\"utf-8\"><title>Images compared</title>"
      "<style>{}</style>\n<h1>Images compared</h1>\n<p>By spectrace {}, commit <code>{}</code>; linear "
      "values, "
      "no tone mapping. Magenta: not a finite number.</p>\n<ul>\n",
      kStyle, version(), commit());
  for (const std::string& line : conventions(settings)) html += fmt::format("<li>{}</li>\n", escaped(line));
  html += "</ul>\n";
  for (const std::string& section : sections) html += section;
  return html + "</html>\n";
}

}  // namespace spectrace::cli
