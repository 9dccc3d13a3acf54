// SPDX-License-Identifier: Apache-2.0
// A cost study to look at: plots, and one page that needs no network and no other file.
#pragma once

#include <array>
#include <string>

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

/// Error against seconds of rendering, a curve a setting.
[[nodiscard]] LineChart error_chart(const CostStudy& study, const CostMetric& metric);
/// Milliseconds a sample and pixel that each forbidden effect saves.
[[nodiscard]] BarChart effects_chart(const CostStudy& study);
[[nodiscard]] std::string cost_page(const CostStudy& study);

}  // namespace spectrace::cli
