// SPDX-License-Identifier: Apache-2.0
#include "cli/report/line_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>

#include "cli/report/canvas.h"
#include "cli/report/colours.h"

namespace spectrace::cli {
namespace {

constexpr double kWidth = 560, kHeight = 380, kLeft = 70, kTop = 40, kBottom = 48, kLegend = 220;  // pixels
constexpr double kLegendStep = 16, kTitleSize = 13;
constexpr Stroke kGrid{"#dddddd", 1, 0};

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

  void draw(Canvas& canvas) const {
    canvas.text({kLeft, 18}, chart_.title, TextAnchor::kStart, 0, kTitleSize);
    axes(canvas);
    for (std::size_t i = 0; i < chart_.curves.size(); ++i) curve(i, canvas);
  }

 private:
  [[nodiscard]] double x_of(double x) const { return kLeft + kWidth * x_.position(x); }
  [[nodiscard]] double y_of(double y) const { return kTop + kHeight * (1 - y_.position(y)); }

  void axes(Canvas& canvas) const {
    const double bottom = kTop + kHeight, right = kLeft + kWidth;
    for (const double x : x_.ticks()) {
      canvas.polyline(std::array{Place{x_of(x), kTop}, Place{x_of(x), bottom}}, kGrid);
      canvas.text({x_of(x), bottom + 15}, fmt::format("{:g}", x), TextAnchor::kMiddle);
    }
    for (const double y : y_.ticks()) {
      canvas.polyline(std::array{Place{kLeft, y_of(y)}, Place{right, y_of(y)}}, kGrid);
      canvas.text({kLeft - 6, y_of(y) + 4}, fmt::format("{:g}", y), TextAnchor::kEnd);
    }
    canvas.text({kLeft + kWidth / 2, bottom + 36}, chart_.x_title, TextAnchor::kMiddle);
    canvas.text({14, kTop + kHeight / 2}, chart_.y_title, TextAnchor::kMiddle, -90);
  }

  void curve(std::size_t i, Canvas& canvas) const {
    const Curve& curve = chart_.curves[i];
    const std::string_view colour = kSeriesColours[i % kSeriesColours.size()];
    // Beyond as many curves as colours, lines are dashed.
    const int round = int(i / kSeriesColours.size());
    const int dash = round == 0 ? 0 : std::max(1, 8 / round);
    std::vector<Place> line;
    for (const CurvePoint& p : curve.line) {
      if (is_drawn(p)) line.push_back({x_of(p.x), y_of(p.y)});
    }
    canvas.polyline(line, {colour, 1.5, dash});
    for (const CurvePoint& p : curve.points) {
      if (is_drawn(p)) canvas.disk({x_of(p.x), y_of(p.y)}, 4, colour, p.label);
    }
    const double y = kTop + 10 + kLegendStep * double(i), x = kLeft + kWidth + 14;
    canvas.polyline(std::array{Place{x, y}, Place{x + 24, y}}, {colour, 2, dash});
    canvas.text({x + 30, y + 4}, curve.name);
  }

  const LineChart& chart_;
  LogAxis x_, y_;
};

/// The legend may be longer than the plot is high.
double height_of(const LineChart& chart) {
  return kTop + std::max(kHeight + kBottom, 10 + kLegendStep * double(chart.curves.size() + 1));
}

}  // namespace

std::string svg(const LineChart& chart) {
  SvgCanvas canvas(kLeft + kWidth + kLegend, height_of(chart));
  Plot(chart).draw(canvas);
  return canvas.document();
}

Image picture(const LineChart& chart) {
  PixelCanvas canvas(kLeft + kWidth + kLegend, height_of(chart));
  Plot(chart).draw(canvas);
  return canvas.image();
}

}  // namespace spectrace::cli
