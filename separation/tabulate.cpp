// SPDX-License-Identifier: Apache-2.0
#include "separation/tabulate.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "materials/half_difference.h"
#include "separation/fill_grid.h"
#include "separation/parallel.h"
#include "separation/reciprocal_pair.h"

namespace spectrace {
namespace {

/// The nodes of one theta_h; rows without a value keep kNoValue.
void tabulate_slice(const MeasuredBrdf& measured, int h, HalfDifferenceTable& table) {
  const HalfDifferenceGrid& grid = table.grid;
  const std::size_t n = table.axis.size();
  std::vector<double> sum(n);
  for (int d = 0; d < grid.n_theta_d; ++d) {
    for (int p = 0; p < grid.n_phi_d; ++p) {
      const DirectionPair directions =
          from_half_difference({grid.theta_h(h), grid.theta_d(d), grid.phi_d(p)});
      if (!(directions.wo.z > 0 && directions.wi.z > 0)) continue;
      const ReciprocalPair pair = locate_pair(measured, directions);
      if (!pair.any) continue;
      std::fill(sum.begin(), sum.end(), 0.0);
      for (std::size_t order = 0; order < 2; ++order) {
        const MeasuredBrdf::Footprint& footprint = pair.footprint[order];
        for (int i = 0; i < footprint.count; ++i) {
          const double weight = pair.scale[order] * double(footprint.weight[i]);
          const float* const spectrum = measured.spectrum(footprint.row[i]);
          for (std::size_t k = 0; k < n; ++k) sum[k] += weight * double(spectrum[k]);
        }
      }
      std::transform(sum.begin(), sum.end(), table.q.begin() + std::ptrdiff_t(grid.index(h, d, p) * n),
                     [](double x) { return static_cast<float>(x); });
    }
  }
}

}  // namespace

HalfDifferenceTable tabulate(const MeasuredBrdf& measured, const SeparationOptions& options) {
  HalfDifferenceTable table{.grid = options.grid, .axis = measured.axis(), .q = {}};
  const std::size_t n = table.axis.size();
  table.q.assign(table.grid.size() * n, kNoValue);
  with_threads(options.threads, [&] {
    parallel_chunks(std::size_t(table.grid.n_theta_h),
                    [&](std::size_t h) { tabulate_slice(measured, static_cast<int>(h), table); });
    parallel_chunks(n, [&](std::size_t k) {
      std::vector<float> channel(table.grid.size());
      for (std::size_t cell = 0; cell < channel.size(); ++cell) channel[cell] = table.q[cell * n + k];
      fill_unmeasured(table.grid, channel);
      for (std::size_t cell = 0; cell < channel.size(); ++cell) table.q[cell * n + k] = channel[cell];
    });
  });
  return table;
}

}  // namespace spectrace
