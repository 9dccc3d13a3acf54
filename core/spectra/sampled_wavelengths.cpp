// SPDX-License-Identifier: Apache-2.0
#include "core/spectra/sampled_wavelengths.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "core/base/error.h"
#include "core/base/wide.h"
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

// A cell is then narrower than the 1 nm of the curves it is made from, but where the density is least. A
// power of two: the place within a cell is exact.
constexpr std::size_t kCells = 1024;
// Cells may meet where Float cannot part their ends: its step between 512 nm and 1024 nm.
constexpr double kLeastWidthNm = 0x1p-14;

}  // namespace

void SampledWavelengths::terminate_secondary() {
  if (kLanes == 1 || secondary_terminated()) return;
  std::fill(pdf_per_nm_.begin() + 1, pdf_per_nm_.end(), Float(0));
  pdf_per_nm_[0] /= kLanes;
}

WavelengthDistribution::WavelengthDistribution(WavelengthRange range, const std::vector<double>& density)
    : range_(range), cells_(kCells) {
  const std::size_t steps = density.size() - 1;
  const double step_nm = double(range.width_nm()) / double(steps);
  std::vector<double> cumulative(density.size());
  for (std::size_t i = 1; i <= steps; ++i) {
    cumulative[i] = cumulative[i - 1] + integrate_linear(density[i - 1], density[i], 1) * step_nm;
  }
  std::size_t step = 0;
  for (std::size_t k = 0; k < kCells; ++k) {
    const double mass = cumulative.back() * double(k) / kCells;
    while (step + 1 < steps && cumulative[step + 1] <= mass) ++step;
    const double t = invert_linear(density[step], density[step + 1], (mass - cumulative[step]) / step_nm);
    cells_[k].begin_nm = static_cast<Float>(double(range.min_nm) + step_nm * (double(step) + t));
  }
  for (std::size_t k = 0; k < kCells; ++k) {
    Cell& cell = cells_[k];
    cell.width_nm = (k + 1 < kCells ? cells_[k + 1].begin_nm : range.max_nm) - cell.begin_nm;
    // A cell too narrow for Float is left out of what pdf_per_nm() finds: nothing but its begin is drawn.
    cell.pdf_per_nm =
        static_cast<Float>(1 / (double(kCells) * std::max(double(cell.width_nm), kLeastWidthNm)));
  }
}

WavelengthDistribution WavelengthDistribution::uniform(WavelengthRange range) {
  SPECTRACE_CHECK(std::isfinite(range.width_nm()) && range.width_nm() > 0);
  return {range, {1.0, 1.0}};
}

WavelengthDistribution WavelengthDistribution::at_centers(WavelengthRange range, std::size_t count) {
  SPECTRACE_CHECK(std::isfinite(range.width_nm()) && range.width_nm() > 0 && count > 0);
  const double width_nm = double(range.width_nm()) / double(count);
  std::vector<Cell> cells(count);
  for (std::size_t i = 0; i < count; ++i) {
    cells[i] = {.begin_nm = static_cast<Float>(double(range.min_nm) + (double(i) + 0.5) * width_nm),
                .width_nm = 0,
                .pdf_per_nm = 1 / range.width_nm()};
  }
  return {range, std::move(cells)};
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
  std::vector<double> density;
  for (std::size_t i = 0; i <= steps; ++i) {
    const double share = is_lit ? (1 - flat) * (lit[i] / mean_lit) : 0;
    density.push_back(flat * seen[i] / mean + share + kVisibleFloor);
  }
  return {range, density};
}

WavelengthDistribution WavelengthDistribution::carrying(int lanes) const {
  SPECTRACE_CHECK(lanes >= 1 && kLanes % lanes == 0);
  WavelengthDistribution result = *this;
  result.step_ = kLanes / lanes;
  result.rotation_ = rotations(result.step_);
  return result;
}

SPECTRACE_WIDE SampledWavelengths WavelengthDistribution::sample(Float u) const {
  std::array<Float, kLanes> position{};
  for (int lane = 0; lane < kLanes; ++lane) {
    // Rotated in the unit interval, so that each lane on its own has this density: Wilkie et al. 2014,
    // sec. 3.
    const Float rotated = u + rotation_[lane];
    position[lane] = rotated < 1 ? rotated : rotated - 1;
  }
  return at(position);
}

SampledWavelengths WavelengthDistribution::sample(Float u, const std::array<Float, kLanes>& shifts) const {
  const auto stratum = static_cast<int>(u * kLanes);
  const Float within = u * kLanes - Float(stratum);
  std::array<Float, kLanes> position{};
  for (int lane = 0; lane < kLanes; ++lane) {
    const int source = source_of(lane);
    const Float moved = within + shifts[source];
    position[lane] = (Float((stratum + source) % kLanes) + (moved < 1 ? moved : moved - 1)) / kLanes;
  }
  return at(position);
}

SPECTRACE_WIDE SampledWavelengths
WavelengthDistribution::at(const std::array<Float, kLanes>& position) const {
  std::array<Float, kLanes> lambda_nm{}, pdf_per_nm_of_lane{};
  Float *const nm = lambda_nm.data(), *const pdf = pdf_per_nm_of_lane.data();
  const Cell* const cells = cells_.data();
  const auto count = static_cast<std::int32_t>(cells_.size());
  for (int lane = 0; lane < kLanes; ++lane) {
    const Float place = position[lane] * Float(count);
    // The product may round up to the number of cells.
    const std::int32_t k = std::min(static_cast<std::int32_t>(place), count - 1);
    nm[lane] = cells[k].begin_nm + (place - Float(k)) * cells[k].width_nm;
    pdf[lane] = cells[k].pdf_per_nm;
  }
  return {lambda_nm, pdf_per_nm_of_lane};
}

Float WavelengthDistribution::pdf_per_nm(Float lambda_nm) const {
  if (!(lambda_nm >= range_.min_nm && lambda_nm <= range_.max_nm)) return 0;
  const auto above = std::upper_bound(cells_.begin() + 1, cells_.end(), lambda_nm,
                                      [](Float nm, const Cell& cell) { return nm < cell.begin_nm; });
  return (above - 1)->pdf_per_nm;
}

}  // namespace spectrace
