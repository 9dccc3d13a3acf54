// SPDX-License-Identifier: Apache-2.0
// The plots of a cost study.
#pragma once

#include <array>
#include <string>
#include <variant>
#include <vector>

#include "cli/cost/measurement.h"
#include "cli/report/bar_chart.h"
#include "cli/report/line_chart.h"

namespace spectrace::cli {

struct CostMetric {
  const char* id;
  const char* title;
  double (*of)(const CostPoint&);
  bool is_fitted;  ///< the error model tells it
};
inline constexpr std::array<CostMetric, 4> kCostMetrics{
    {{"rel_mse", "relMSE", [](const CostPoint& p) { return p.metrics.rel_mse; }, true},
     {"mape", "MAPE", [](const CostPoint& p) { return p.metrics.mape; }, false},
     {"psnr_db", "PSNR [dB]", [](const CostPoint& p) { return p.metrics.psnr_db; }, false},
     {"ciede2000", "CIEDE2000", [](const CostPoint& p) { return p.ciede2000; }, false}}};

/// The exact setting's and its counterpart's with the other sampler; null where none was measured.
struct SamplerPair {
  const CostRecord* stratified = nullptr;
  const CostRecord* independent = nullptr;
};
[[nodiscard]] SamplerPair samplers_of(const CostStudy& study);

/// Error against seconds of rendering, a curve a setting.
[[nodiscard]] LineChart error_chart(const CostStudy& study, const CostMetric& metric);
/// Those that no other beats, a curve; all others as dots.
[[nodiscard]] LineChart pareto_chart(const CostStudy& study);
/// The noise part of relMSE against seconds of sampling, by each sampler, beside 1/time.
[[nodiscard]] LineChart noise_chart(const CostStudy& study);
/// Seconds of so many samples that each effect takes.
[[nodiscard]] BarChart effects_chart(const CostStudy& study);

struct CostPlot {
  std::string id;
  std::variant<LineChart, BarChart> chart;

  [[nodiscard]] std::string to_svg() const {
    return std::visit([](const auto& c) { return svg(c); }, chart);
  }
  [[nodiscard]] Image to_picture() const {
    return std::visit([](const auto& c) { return picture(c); }, chart);
  }
};
/// A plot a metric first.
[[nodiscard]] std::vector<CostPlot> plots_of(const CostStudy& study);

}  // namespace spectrace::cli
