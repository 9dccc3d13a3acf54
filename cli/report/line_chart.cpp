// SPDX-License-Identifier: Apache-2.0
#include "cli/report/line_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

#include "cli/report/bar_chart.h"
#include "cli/report/colours.h"

namespace spectrace::cli {
namespace {

constexpr double kWidth = 560, kHeight = 380, kLeft = 70, kTop = 40, kBottom = 48, kLegend = 220;  // pixels

bool is_drawn(const CurvePoint& p) { return p.x > 0 && p.y > 0 && std::isfinite(p.x) && std::isfinite(p.y); }

/// One axis: from decades, or parts of one, to pixels.
class LogAxis {
 public:
  void include(double value) {
    low_ = std::min(low_, std::log10(value));
    high_ = std::max(high_, std::log10(value));
  }
  /// Room on both sides; something to show where there was nothing.
  void finish() {
    if (!(low_ <= high_)) low_ = high_ = 0;
    const double margin = std::max(0.04 * (high_ - low_), 0.05);
    low_ -= margin;
    high_ += margin;
  }
  /// In [0, 1].
  [[nodiscard]] double position(double value) const { return (std::log10(value) - low_) / (high_ - low_); }
  /// 1, 2 and 5 of each decade; decades alone where those are many.
  [[nodiscard]] std::vector<double> ticks() const {
    std::vector<double> all;
    for (int decade = int(std::floor(low_)); decade <= int(std::ceil(high_)); ++decade) {
      for (const double digit : {1.0, 2.0, 5.0}) {
        const double tick = digit * std::pow(10.0, decade);
        const bool is_inside = position(tick) >= 0 && position(tick) <= 1;
        if (is_inside && (digit == 1 || high_ - low_ < 3)) all.push_back(tick);
      }
    }
    return all;
  }

 private:
  double low_ = std::numeric_limits<double>::infinity(), high_ = -low_;
};

class Plot {
 public:
  explicit Plot(const LineChart& chart) : chart_(chart) {
    for (const Curve& curve : chart.curves) {
      for (const auto* points : {&curve.points, &curve.line}) {
        for (const CurvePoint& p : *points) {
          if (!is_drawn(p)) continue;
          x_.include(p.x);
          y_.include(p.y);
        }
      }
    }
    x_.finish();
    y_.finish();
  }

  std::string text() {
    text_ = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:.0f} {1:.0f}\" width=\"{0:.0f}\" "
        "height=\"{1:.0f}\" font-family=\"sans-serif\" font-size=\"11\">\n"
        "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n"
        "<text x=\"{2}\" y=\"18\" font-size=\"13\">{3}</text>\n",
        kLeft + kWidth + kLegend, kTop + kHeight + kBottom, kLeft, escaped(chart_.title));
    axes();
    for (std::size_t i = 0; i < chart_.curves.size(); ++i) curve(i);
    return text_ + "</svg>\n";
  }

 private:
  [[nodiscard]] double x_of(double x) const { return kLeft + kWidth * x_.position(x); }
  [[nodiscard]] double y_of(double y) const { return kTop + kHeight * (1 - y_.position(y)); }

  void axes() {
    for (const double x : x_.ticks()) {
      text_ += fmt::format(
          "<line x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1}\" y2=\"{2}\" stroke=\"#dddddd\"/>"
          "<text x=\"{0:.1f}\" y=\"{3}\" text-anchor=\"middle\">{4:g}</text>\n",
          x_of(x), kTop, kTop + kHeight, kTop + kHeight + 15, x);
    }
    for (const double y : y_.ticks()) {
      text_ += fmt::format(
          "<line x1=\"{0}\" x2=\"{1}\" y1=\"{2:.1f}\" y2=\"{2:.1f}\" stroke=\"#dddddd\"/>"
          "<text x=\"{3}\" y=\"{4:.1f}\" text-anchor=\"end\">{5:g}</text>\n",
          kLeft, kLeft + kWidth, y_of(y), kLeft - 6, y_of(y) + 4, y);
    }
    text_ += fmt::format(
        "<text x=\"{0}\" y=\"{1}\" text-anchor=\"middle\">{2}</text>"
        "<text x=\"14\" y=\"{3}\" text-anchor=\"middle\" transform=\"rotate(-90 14 {3})\">{4}</text>\n",
        kLeft + kWidth / 2, kTop + kHeight + 36, escaped(chart_.x_title), kTop + kHeight / 2,
        escaped(chart_.y_title));
  }

  void curve(std::size_t i) {
    const Curve& curve = chart_.curves[i];
    const std::string_view colour = kSeriesColours[i % kSeriesColours.size()];
    // Beyond as many curves as colours, lines are dashed.
    const std::size_t round = i / kSeriesColours.size();
    const std::string dash = round == 0 ? "" : fmt::format(" stroke-dasharray=\"{} 3\"", 8 / round);
    std::string path;
    for (const CurvePoint& p : curve.line) {
      if (is_drawn(p)) path += fmt::format("{}{:.1f},{:.1f}", path.empty() ? "" : " ", x_of(p.x), y_of(p.y));
    }
    text_ += fmt::format("<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.5\"{}/>\n",
                         path, colour, dash);
    for (const CurvePoint& p : curve.points) {
      if (!is_drawn(p)) continue;
      text_ += fmt::format(
          "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4\" fill=\"{}\" "
          "data-label=\"{}\"><title>{}</title></circle>\n",
          x_of(p.x), y_of(p.y), colour, escaped(p.label), escaped(p.label));
    }
    const double y = kTop + 10 + 16 * double(i), x = kLeft + kWidth + 14;
    text_ += fmt::format(
        "<line x1=\"{0}\" x2=\"{1}\" y1=\"{2}\" y2=\"{2}\" stroke=\"{3}\" stroke-width=\"2\"{4}/>"
        "<text x=\"{5}\" y=\"{6}\">{7}</text>\n",
        x, x + 24, y, colour, dash, x + 30, y + 4, escaped(curve.name));
  }

  const LineChart& chart_;
  LogAxis x_, y_;
  std::string text_;
};

}  // namespace

std::string svg(const LineChart& chart) { return Plot(chart).text(); }

}  // namespace spectrace::cli
