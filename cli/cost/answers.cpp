// SPDX-License-Identifier: Apache-2.0
#include "cli/cost/answers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace spectrace::cli {

namespace {

/// Independent samples are there to hold stratified ones against: in no time are they the better.
bool is_for_comparison(const CostRecord& record) {
  return record.knob == kSamplerKnob && record.name == sampler_name(SamplerKind::kIndependent);
}

}  // namespace

std::optional<Answer> cheapest(const CostStudy& study, double rel_mse) {
  std::optional<Answer> best;
  for (const CostRecord& record : study.records) {
    const std::optional<double> samples = record.model.samples_for(rel_mse);
    if (!samples || is_for_comparison(record)) continue;
    const double seconds = record.model.seconds(*samples);
    if (!best || seconds < best->seconds) best = {rel_mse, &record, *samples, seconds};
  }
  return best;
}

std::optional<Answer> best_within(const CostStudy& study, double seconds) {
  std::optional<Answer> best;
  for (const CostRecord& record : study.records) {
    const ErrorModel& model = record.model;
    const double samples = (seconds - model.start) / model.per_sample;
    if (!(samples >= 1) || is_for_comparison(record)) continue;
    const double rel_mse = model.rel_mse(samples);
    if (!best || rel_mse < best->rel_mse) best = {rel_mse, &record, samples, seconds};
  }
  return best;
}

std::string bias_text(const Estimate& bias) {
  constexpr double kSignificant = 3;  // standard errors
  const double percent = 100 * std::sqrt(std::max(bias.value, kSignificant * bias.standard_error));
  const bool is_known = bias.value > kSignificant * bias.standard_error;
  return fmt::format("{}{:.2g}", is_known ? "" : "< ", percent);
}

std::vector<double> errors_to_ask_for(const CostStudy& study) {
  double most = 0;
  for (const CostRecord& record : study.records) {
    most = std::max(most, record.points.front().metrics.rel_mse);
  }
  std::vector<double> errors;
  for (int decade = int(std::ceil(std::log10(most))); decade > -20; --decade) {
    for (const double digit : {5.0, 2.0, 1.0}) {
      const double error = digit * std::pow(10.0, decade);
      if (error < study.reference_rel_mse) return errors;
      if (error <= most) errors.push_back(error);
    }
  }
  return errors;
}

std::vector<FrontPoint> pareto_front(const CostStudy& study) {
  std::vector<FrontPoint> all;
  for (const CostRecord& record : study.records) {
    for (const CostPoint& point : record.points) all.push_back({&record, &point});
  }
  std::sort(all.begin(), all.end(),
            [](const FrontPoint& a, const FrontPoint& b) { return a.point->seconds < b.point->seconds; });
  std::vector<FrontPoint> front;
  double least = std::numeric_limits<double>::infinity();
  for (const FrontPoint& candidate : all) {
    if (!(candidate.point->metrics.rel_mse < least)) continue;
    least = candidate.point->metrics.rel_mse;
    front.push_back(candidate);
  }
  return front;
}

}  // namespace spectrace::cli
