// SPDX-License-Identifier: Apache-2.0
#include "core/spectra/sampled_wavelengths.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "core/base/error.h"
#include "core/math/math.h"
#include "core/math/piecewise_linear.h"
#include "core/spectra/color.h"

namespace spectrace {
namespace {

// The floor of visible(): at its densest the observer's curve is 100 times this, so the few paths that fall
// on wavelengths the eye hardly sees carry at most that weight.
constexpr double kVisibleFloor = 0.02;
// Of the lights' power may be what no pixel sees: five times the variance, where it is all, is the price.
constexpr double kFlatShare = 0.2;

constexpr int kGuides = 1024;  // more than cells: a search then tries two or three

}  // namespace

void SampledWavelengths::terminate_secondary() {
  if (kLanes == 1 || secondary_terminated()) return;
  std::fill(pdf_per_nm_.begin() + 1, pdf_per_nm_.end(), Float(0));
  pdf_per_nm_[0] /= kLanes;
}

WavelengthDistribution::WavelengthDistribution(WavelengthRange range, std::vector<Float> density)
    : range_(range), density_(std::move(density)), cumulative_(density_.size()) {
  const double step_nm = double(range.width_nm()) / double(density_.size() - 1);
  double total = 0;
  for (std::size_t i = 1; i < density_.size(); ++i) {
    total += 0.5 * step_nm * (double(density_[i - 1]) + double(density_[i]));
  }
  double sum = 0;
  for (std::size_t i = 1; i < density_.size(); ++i) {
    sum += 0.5 * step_nm * (double(density_[i - 1]) + double(density_[i]));
    cumulative_[i] = sum / total;
  }
  cumulative_.back() = 1;
  for (Float& d : density_) d = static_cast<Float>(double(d) / total);
  const int cells = static_cast<int>(density_.size()) - 1;
  for (int g = 0; g < kGuides; ++g) {
    guide_.push_back(find_cell(cells, double(g) / kGuides,
                               [&](int node) { return cumulative_[static_cast<std::size_t>(node)]; }));
  }
}

WavelengthDistribution WavelengthDistribution::uniform(WavelengthRange range) {
  SPECTRACE_CHECK(std::isfinite(range.width_nm()) && range.width_nm() > 0);
  return {range, {1, 1}};
}

WavelengthDistribution WavelengthDistribution::visible(WavelengthRange range,
                                                       const std::function<double(double)>& emission) {
  SPECTRACE_CHECK(std::isfinite(range.width_nm()) && range.width_nm() > 0);
  const auto steps = static_cast<std::size_t>(std::ceil(double(range.width_nm())));
  std::vector<double> seen(steps + 1), lit(steps + 1);
  double mean = 0, mean_lit = 0;
  for (std::size_t i = 0; i <= steps; ++i) {
    const double nm = range.min_nm + double(range.width_nm()) * double(i) / double(steps);
    const Rgb rgb = xyz_to_rgb(cie_xyz_bar(nm));
    seen[i] = std::hypot(rgb[0], rgb[1], rgb[2]);
    lit[i] = emission ? seen[i] * emission(nm) : 0;
    mean += seen[i] / double(steps + 1);
    mean_lit += lit[i] / double(steps + 1);
  }
  if (mean == 0) return uniform(range);  // a range nobody sees
  const bool is_lit = mean_lit > 0 && std::isfinite(mean_lit);
  const double flat = is_lit ? kFlatShare : 1;
  std::vector<Float> density;
  for (std::size_t i = 0; i <= steps; ++i) {
    const double share = is_lit ? (1 - flat) * (lit[i] / mean_lit) : 0;
    density.push_back(static_cast<Float>(flat * seen[i] / mean + share + kVisibleFloor));
  }
  return {range, std::move(density)};
}

SampledWavelengths WavelengthDistribution::sample(Float u) const {
  const int cells = static_cast<int>(density_.size()) - 1;
  std::array<Float, kLanes> lambda_nm{}, pdf_per_nm_of_lane{};
  for (int lane = 0; lane < kLanes; ++lane) {
    // Rotated in the unit interval, so that each lane on its own has this density: Wilkie et al. 2014,
    // sec. 3.
    double v = clamp_unit(u) + double(lane) / kLanes;
    if (v >= 1) v -= 1;
    int i = guide_[std::min(static_cast<std::size_t>(v * kGuides), std::size_t{kGuides - 1})];
    while (i + 1 < cells && cumulative_[static_cast<std::size_t>(i) + 1] <= v) ++i;
    const auto k = static_cast<std::size_t>(i);
    const double step_nm = double(range_.width_nm()) / cells;
    const double t = invert_linear(density_[k], density_[k + 1], (v - cumulative_[k]) / step_nm);
    const auto l = static_cast<std::size_t>(lane);
    lambda_nm[l] = std::clamp(static_cast<Float>(double(range_.min_nm) + step_nm * (i + t)), range_.min_nm,
                              range_.max_nm);
    pdf_per_nm_of_lane[l] = pdf_per_nm(lambda_nm[l]);
  }
  return {lambda_nm, pdf_per_nm_of_lane};
}

Float WavelengthDistribution::pdf_per_nm(Float lambda_nm) const {
  if (!(lambda_nm >= range_.min_nm && lambda_nm <= range_.max_nm)) return 0;
  const auto cells = density_.size() - 1;
  const Float position = (lambda_nm - range_.min_nm) / range_.width_nm() * Float(cells);
  const auto i = std::min(static_cast<std::size_t>(position), cells - 1);
  return lerp(density_[i], density_[i + 1], position - Float(i));
}

}  // namespace spectrace
