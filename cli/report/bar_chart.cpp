// SPDX-License-Identifier: Apache-2.0
#include "cli/report/bar_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "cli/report/colours.h"

namespace spectrace::cli {
namespace {

constexpr double kHeight = 240, kLeft = 46, kTop = 44, kBottom = 130;  // pixels
constexpr double kBarWidth = 7, kGroupGap = 10;

/// A round step that gives about five lines.
double step_for(double range) {
  const double rough = range / 5, power = std::pow(10, std::floor(std::log10(rough)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (rough <= factor * power) return factor * power;
  }
  return 10 * power;
}

}  // namespace

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

std::string svg(const BarChart& chart) {
  double most = 1e-9;
  for (const BarSeries& s : chart.series) {
    for (const double v : s.values) {
      if (std::isfinite(v)) most = std::max(most, v);
    }
  }
  const double step = step_for(most), top_value = std::ceil(most / step) * step;
  const double group_width = double(chart.series.size()) * kBarWidth + kGroupGap;
  const double width = kLeft + double(chart.groups.size()) * group_width + 20;
  const auto y_of = [&](double v) { return kTop + kHeight * (1 - v / top_value); };

  std::string text = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:.0f} {1:.0f}\" width=\"{0:.0f}\" "
      "height=\"{1:.0f}\" font-family=\"sans-serif\" font-size=\"11\">\n"
      "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n"
      "<text x=\"{2}\" y=\"16\" font-size=\"13\">{3} [{4}]</text>\n",
      std::max(width, 420.0), kTop + kHeight + kBottom, kLeft, escaped(chart.title), escaped(chart.unit));
  for (double v = 0; v <= top_value * 1.0001; v += step) {
    text += fmt::format(
        "<line x1=\"{0}\" x2=\"{1:.1f}\" y1=\"{2:.1f}\" y2=\"{2:.1f}\" stroke=\"#dddddd\"/>"
        "<text x=\"{3}\" y=\"{4:.1f}\" text-anchor=\"end\">{5:g}</text>\n",
        kLeft, width - 10, y_of(v), kLeft - 5, y_of(v) + 4, v);
  }
  for (std::size_t s = 0; s < chart.series.size(); ++s) {
    const std::string_view colour = kSeriesColours[s % kSeriesColours.size()];
    const double x = kLeft + 95 * double(s);
    text += fmt::format(
        "<rect x=\"{}\" y=\"24\" width=\"10\" height=\"10\" fill=\"{}\"/>"
        "<text x=\"{}\" y=\"33\">{}</text>\n",
        x, colour, x + 14, escaped(chart.series[s].name));
    for (std::size_t g = 0; g < chart.groups.size() && g < chart.series[s].values.size(); ++g) {
      const double v = chart.series[s].values[g];
      if (!std::isfinite(v)) continue;
      text += fmt::format(
          "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{}\" height=\"{:.1f}\" fill=\"{}\"><title>{}, {}: {:.2f} "
          "{}</title></rect>\n",
          kLeft + double(g) * group_width + kGroupGap / 2 + double(s) * kBarWidth, y_of(std::max(v, 0.0)),
          kBarWidth - 1, kTop + kHeight - y_of(std::max(v, 0.0)), colour, escaped(chart.groups[g]),
          escaped(chart.series[s].name), v, escaped(chart.unit));
    }
  }
  for (std::size_t g = 0; g < chart.groups.size(); ++g) {
    const double x = kLeft + (double(g) + 0.5) * group_width, y = kTop + kHeight + 10;
    text += fmt::format(
        "<text x=\"{0:.1f}\" y=\"{1:.1f}\" text-anchor=\"end\" transform=\"rotate(-60 {0:.1f} {1:.1f})\">"
        "{2}</text>\n",
        x, y, escaped(chart.groups[g]));
  }
  return text + "</svg>\n";
}

}  // namespace spectrace::cli
