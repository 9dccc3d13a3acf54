// SPDX-License-Identifier: Apache-2.0
// Table X of an analytic material, exact in every cell: what the fits are tested on without a measurement.
#pragma once

#include <cmath>
#include <functional>

#include "materials/half_difference.h"
#include "separation/cell_table.h"

namespace spectrace::test {

/// cos_h, cos_d, cos_i, cos_o -> achromatic BRDF [1/sr]
using AchromaticBrdf = std::function<double(double, double, double, double)>;

inline CellTable synthetic_cells(const SeparationOptions& options, const AchromaticBrdf& brdf) {
  CellTable table;
  table.grid = options.grid;
  const HalfDifferenceGrid& grid = table.grid;
  table.mean_q.assign(grid.size(), -1.0F);
  table.counts.cells = grid.size();
  for (int h = 0; h < grid.n_theta_h; ++h) {
    for (int d = 0; d < grid.n_theta_d; ++d) {
      table.begin.push_back(static_cast<std::uint32_t>(table.cell.size()));
      for (int p = 0; p < grid.n_phi_d; ++p) {
        const DirectionPair pair = from_half_difference({grid.theta_h(h), grid.theta_d(d), grid.phi_d(p)});
        if (!(pair.wo.z > 0 && pair.wi.z > 0)) {
          ++table.counts.below_horizon;
          continue;
        }
        const double cos_i = pair.wi.z, cos_o = pair.wo.z;
        const double f = brdf(std::cos(grid.theta_h(h)), std::cos(grid.theta_d(d)), cos_i, cos_o);
        table.mean_q[grid.index(h, d, p)] = static_cast<float>(f * (cos_i + cos_o));
        table.cell.push_back(static_cast<std::uint32_t>(grid.index(h, d, p)));
        table.cos_i.push_back(static_cast<float>(cos_i));
        table.cos_o.push_back(static_cast<float>(cos_o));
        table.weight.push_back(static_cast<float>(cosine_weight(cos_i, cos_o, options)));
        table.mean.push_back(static_cast<float>(f));
        ++table.counts.measured;
      }
    }
  }
  table.begin.push_back(static_cast<std::uint32_t>(table.cell.size()));
  table.node_begin.assign(table.cell.size() + 1, 0);
  return table;
}

}  // namespace spectrace::test
