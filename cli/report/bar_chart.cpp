// SPDX-License-Identifier: Apache-2.0
#include "cli/report/bar_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "cli/report/canvas.h"
#include "cli/report/colours.h"

namespace spectrace::cli {
namespace {

constexpr double kHeight = 240, kLeft = 46, kTop = 44, kBottom = 130;  // pixels
constexpr double kBarWidth = 7, kGroupGap = 10;
constexpr double kLeastWidth = 420, kTitleSize = 13;

/// A round step that gives about five lines.
double step_for(double range) {
  const double rough = range / 5, power = std::pow(10, std::floor(std::log10(rough)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (rough <= factor * power) return factor * power;
  }
  return 10 * power;
}

class Bars {
 public:
  explicit Bars(const BarChart& chart) : chart_(chart) {
    double most = 1e-9;
    for (const BarSeries& s : chart.series) {
      for (const double v : s.values) {
        if (std::isfinite(v)) most = std::max(most, v);
      }
    }
    step_ = step_for(most);
    top_value_ = std::ceil(most / step_) * step_;
    group_width_ = double(chart.series.size()) * kBarWidth + kGroupGap;
    inner_width_ = kLeft + double(chart.groups.size()) * group_width_ + 20;
  }

  [[nodiscard]] double width() const { return std::max(inner_width_, kLeastWidth); }
  [[nodiscard]] static double height() { return kTop + kHeight + kBottom; }

  void draw(Canvas& canvas) const {
    canvas.text({kLeft, 16}, fmt::format("{} [{}]", chart_.title, chart_.unit), TextAnchor::kStart, 0,
                kTitleSize);
    for (double v = 0; v <= top_value_ * 1.0001; v += step_) {
      canvas.polyline(std::array{Place{kLeft, y_of(v)}, Place{inner_width_ - 10, y_of(v)}},
                      {"#dddddd", 1, 0});
      canvas.text({kLeft - 5, y_of(v) + 4}, fmt::format("{:g}", v), TextAnchor::kEnd);
    }
    for (std::size_t s = 0; s < chart_.series.size(); ++s) series(s, canvas);
    for (std::size_t g = 0; g < chart_.groups.size(); ++g) {
      const double x = kLeft + (double(g) + 0.5) * group_width_;
      canvas.text({x, kTop + kHeight + 10}, chart_.groups[g], TextAnchor::kEnd, -60);
    }
  }

 private:
  [[nodiscard]] double y_of(double v) const { return kTop + kHeight * (1 - v / top_value_); }

  void series(std::size_t s, Canvas& canvas) const {
    const BarSeries& of = chart_.series[s];
    const std::string_view colour = kSeriesColours[s % kSeriesColours.size()];
    const double x = kLeft + 95 * double(s);
    canvas.box({x, 24}, 10, 10, colour, "");
    canvas.text({x + 14, 33}, of.name);
    for (std::size_t g = 0; g < chart_.groups.size() && g < of.values.size(); ++g) {
      const double v = of.values[g];
      if (!std::isfinite(v)) continue;
      const double top = y_of(std::max(v, 0.0));
      const double left = kLeft + double(g) * group_width_ + kGroupGap / 2 + double(s) * kBarWidth;
      canvas.box({left, top}, kBarWidth - 1, kTop + kHeight - top, colour,
                 fmt::format("{}, {}: {:.3g} {}", chart_.groups[g], of.name, v, chart_.unit));
    }
  }

  const BarChart& chart_;
  double step_ = 1, top_value_ = 1, group_width_ = 1, inner_width_ = 1;
};

}  // namespace

std::string svg(const BarChart& chart) {
  const Bars bars(chart);
  SvgCanvas canvas(bars.width(), Bars::height());
  bars.draw(canvas);
  return canvas.document();
}

Image picture(const BarChart& chart) {
  const Bars bars(chart);
  PixelCanvas canvas(bars.width(), Bars::height());
  bars.draw(canvas);
  return canvas.image();
}

}  // namespace spectrace::cli
