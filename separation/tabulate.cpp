// SPDX-License-Identifier: Apache-2.0
#include "separation/tabulate.h"

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "materials/half_difference.h"
#include "separation/fill_grid.h"
#include "separation/parallel.h"
#include "separation/reciprocal_pair.h"

namespace spectrace {
namespace {

/// `sum` += scale times the spectrum that a footprint interpolates.
void add_spectrum(const MeasuredBrdf& measured, const MeasuredBrdf::Footprint& footprint, double scale,
                  std::span<double> sum) {
  for (int i = 0; i < footprint.count; ++i) {
    const double weight = scale * double(footprint.weight[i]);
    const float* const spectrum = measured.spectrum(footprint.row[i]);
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += weight * double(spectrum[k]);
  }
}

/// q = f (cosθi + cosθo), both orders averaged.
bool add_bounded(const MeasuredBrdf& measured, const DirectionPair& directions, std::span<double> sum) {
  const ReciprocalPair pair = locate_pair(measured, directions);
  for (std::size_t order = 0; order < 2; ++order) {
    add_spectrum(measured, pair.footprint[order], pair.scale[order], sum);
  }
  return pair.any;
}

/// f as the file gives it in one order; without a bound on the cosine a node at the horizon outshines all.
bool add_plain(const MeasuredBrdf& measured, const DirectionPair& directions, std::span<double> sum) {
  constexpr double kLeastCosine = 1e-3;  // the paper's epsilon
  const auto footprint = measured.footprint(directions.wo, directions.wi);
  if (footprint) add_spectrum(measured, *footprint, 1 / std::max(double(directions.wi.z), kLeastCosine), sum);
  return footprint.has_value();
}

/// What q loses of f cosθi.
bool add_odd(const MeasuredBrdf& measured, const DirectionPair& directions, std::span<double> sum) {
  const ReciprocalPair pair = locate_pair(measured, directions);
  const std::array<double, 2> scale = pair.odd_scale(directions);
  for (std::size_t order = 0; order < 2; ++order) {
    add_spectrum(measured, pair.footprint[order], scale[order], sum);
  }
  return pair.any;
}

using AddNode = bool (*)(const MeasuredBrdf&, const DirectionPair&, std::span<double>);
using Fill = void (*)(const HalfDifferenceGrid&, std::vector<float>&);

/// [cell][axis]: every node that `add` has a value for; the rest keep kNoValue.
std::vector<float> node_values(const MeasuredBrdf& measured, const HalfDifferenceGrid& grid, AddNode add) {
  const std::size_t n = measured.axis().size();
  std::vector<float> values(grid.size() * n, kNoValue);
  parallel_chunks(std::size_t(grid.n_theta_h), [&](std::size_t slice) {
    const int h = static_cast<int>(slice);
    std::vector<double> sum(n);
    for (int d = 0; d < grid.n_theta_d; ++d) {
      for (int p = 0; p < grid.n_phi_d; ++p) {
        const DirectionPair directions =
            from_half_difference({grid.theta_h(h), grid.theta_d(d), grid.phi_d(p)});
        if (!(directions.wo.z > 0 && directions.wi.z > 0)) continue;
        std::fill(sum.begin(), sum.end(), 0.0);
        if (!add(measured, directions, sum)) continue;
        std::transform(sum.begin(), sum.end(), values.begin() + std::ptrdiff_t(grid.index(h, d, p) * n),
                       [](double x) { return static_cast<float>(x); });
      }
    }
  });
  return values;
}

// Wavelengths that a task fills at once: a cache line of a cell's spectrum, read and written whole.
constexpr std::size_t kFillBlock = 16;

/// The same without gaps.
std::vector<float> filled_values(const MeasuredBrdf& measured, const HalfDifferenceGrid& grid, AddNode add,
                                 Fill fill) {
  std::vector<float> values = node_values(measured, grid, add);
  const std::size_t n = measured.axis().size();
  parallel_chunks((n + kFillBlock - 1) / kFillBlock, [&](std::size_t block) {
    const std::size_t first = block * kFillBlock, count = std::min(kFillBlock, n - first);
    std::vector<std::vector<float>> channels(count, std::vector<float>(grid.size()));
    for (std::size_t cell = 0; cell < grid.size(); ++cell) {
      for (std::size_t k = 0; k < count; ++k) channels[k][cell] = values[cell * n + first + k];
    }
    for (std::vector<float>& channel : channels) fill(grid, channel);
    for (std::size_t cell = 0; cell < grid.size(); ++cell) {
      for (std::size_t k = 0; k < count; ++k) values[cell * n + first + k] = channels[k][cell];
    }
  });
  return values;
}

}  // namespace

HalfDifferenceTable tabulate(const MeasuredBrdf& measured, const SeparationOptions& options) {
  HalfDifferenceTable table{.grid = options.grid, .axis = measured.axis(), .q = {}};
  with_threads(options.threads,
               [&] { table.q = filled_values(measured, table.grid, add_bounded, fill_unmeasured); });
  return table;
}

HalfDifferenceTable tabulate_oriented(const MeasuredBrdf& measured, const SeparationOptions& options) {
  HalfDifferenceTable table = tabulate(measured, options);
  with_threads(options.threads,
               [&] { table.odd = filled_values(measured, table.grid, add_odd, fill_unmeasured_odd); });
  return table;
}

HalfDifferenceTable tabulate_plain(const MeasuredBrdf& measured, const SeparationOptions& options) {
  HalfDifferenceTable table{.grid = options.grid, .axis = measured.axis(), .q = {}};
  with_threads(options.threads, [&] { table.q = node_values(measured, table.grid, add_plain); });
  return table;
}

}  // namespace spectrace
