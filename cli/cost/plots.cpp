// SPDX-License-Identifier: Apache-2.0
#include "cli/cost/plots.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cli/cost/answers.h"

namespace spectrace::cli {

namespace {

constexpr int kLinePoints = 40;
/// Of the bars: as many as a picture is worth looking at.
constexpr int kBarSamples = 100;

std::string point_label(const CostRecord& record, const CostPoint& point) {
  return fmt::format(
      "{}, {} samples: {:.3g} s, relMSE {:.3g}, MAPE {:.3g} %, PSNR {:.2f} dB, CIEDE2000 {:.3g}",
      record.title, point.spp, point.seconds, point.metrics.rel_mse, 100 * point.metrics.mape,
      point.metrics.psnr_db, point.ciede2000);
}

std::string time_title(const CostStudy& study) {
  return fmt::format("seconds of rendering, {} threads", study.threads);
}

/// Samples from the fewest to the most of a record, evenly by their logarithms.
std::vector<double> samples_along(const CostRecord& record) {
  const double first = record.points.front().spp, ratio = record.points.back().spp / first;
  std::vector<double> samples;
  for (int i = 0; i <= kLinePoints; ++i) samples.push_back(first * std::pow(ratio, double(i) / kLinePoints));
  return samples;
}

Curve noise_curve(const CostStudy& study, const CostRecord& record) {
  const ErrorModel& model = record.model;
  Curve curve{
      .name = fmt::format("{}: slope -{:.2f}", record.name, model.exponent), .points = {}, .line = {}};
  for (const CostPoint& point : record.points) {
    const double noise = point.metrics.rel_mse - model.bias - study.reference_rel_mse;
    curve.points.push_back({point.spp * model.per_sample, noise, point_label(record, point)});
  }
  for (const double samples : samples_along(record)) {
    curve.line.push_back({samples * model.per_sample, model.rel_mse(samples) - model.bias, ""});
  }
  return curve;
}

}  // namespace

SamplerPair samplers_of(const CostStudy& study) {
  const CostRecord& own = study.records.front();
  const auto other = std::find_if(study.records.begin(), study.records.end(),
                                  [](const CostRecord& r) { return r.knob == kSamplerKnob; });
  if (other == study.records.end()) return {};
  const bool is_independent = other->name == sampler_name(SamplerKind::kIndependent);
  return is_independent ? SamplerPair{&own, &*other} : SamplerPair{&*other, &own};
}

LineChart error_chart(const CostStudy& study, const CostMetric& metric) {
  LineChart chart{.title = fmt::format("{} against time", metric.title),
                  .x_title = time_title(study),
                  .y_title = metric.title,
                  .curves = {}};
  for (const CostRecord& record : study.records) {
    Curve curve{.name = record.title, .points = {}, .line = {}};
    for (const CostPoint& point : record.points) {
      curve.points.push_back({point.seconds, metric.of(point), point_label(record, point)});
    }
    if (metric.is_fitted) {
      for (const double samples : samples_along(record)) {
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

LineChart pareto_chart(const CostStudy& study) {
  LineChart chart{.title = "renders that no other beats in both time and error",
                  .x_title = time_title(study),
                  .y_title = "relMSE",
                  .curves = {}};
  Curve others{.name = "all others", .points = {}, .line = {}};
  for (const CostRecord& record : study.records) {
    for (const CostPoint& point : record.points) {
      others.points.push_back({point.seconds, point.metrics.rel_mse, point_label(record, point)});
    }
  }
  Curve front{.name = "Pareto front", .points = {}, .line = {}};
  for (const FrontPoint& point : pareto_front(study)) {
    front.points.push_back(
        {point.point->seconds, point.point->metrics.rel_mse, point_label(*point.record, *point.point)});
  }
  front.line = front.points;
  chart.curves = {std::move(others), std::move(front)};
  return chart;
}

LineChart noise_chart(const CostStudy& study) {
  LineChart chart{.title = "noise part of relMSE against time",
                  .x_title = "seconds of sampling",
                  .y_title = "relMSE without bias",
                  .curves = {}};
  const SamplerPair samplers = samplers_of(study);
  if (samplers.independent == nullptr) return chart;
  chart.curves = {noise_curve(study, *samplers.stratified), noise_curve(study, *samplers.independent)};
  Curve guide{.name = "1/time", .points = {}, .line = {}};
  const ErrorModel& model = samplers.independent->model;
  const double first = samplers.independent->points.front().spp;
  for (const double samples : samples_along(*samplers.independent)) {
    const double noise = (model.rel_mse(first) - model.bias) * first / samples;
    guide.line.push_back({samples * model.per_sample, noise, ""});
  }
  chart.curves.push_back(std::move(guide));
  return chart;
}

BarChart effects_chart(const CostStudy& study) {
  const double exact = study.records.front().model.per_sample;
  BarChart chart{.title = fmt::format("what {} samples a pixel take less without", kBarSamples),
                 .unit = "s",
                 .groups = {},
                 .series = {}};
  BarSeries series{.name = fmt::format("of {:.3g} s", exact * kBarSamples), .values = {}};
  for (const CostRecord& record : study.records) {
    if (record.knob != "without" && record.knob != "path depth") continue;
    chart.groups.push_back(record.title);
    series.values.push_back(std::max(0.0, kBarSamples * (exact - record.model.per_sample)));
  }
  chart.series.push_back(std::move(series));
  return chart;
}

std::vector<CostPlot> plots_of(const CostStudy& study) {
  std::vector<CostPlot> plots;
  for (const CostMetric& metric : kCostMetrics) plots.push_back({metric.id, error_chart(study, metric)});
  plots.push_back({"pareto", pareto_chart(study)});
  plots.push_back({"noise", noise_chart(study)});
  plots.push_back({"effects", effects_chart(study)});
  return plots;
}

}  // namespace spectrace::cli
