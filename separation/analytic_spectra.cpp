// SPDX-License-Identifier: Apache-2.0
#include "separation/analytic_spectra.h"

#include <cstddef>
#include <utility>

#include "separation/parallel.h"

namespace spectrace {
namespace {

// Four parameters need no million cells: one in 29 (a prime, which divides no dimension of the paper's grid)
// moves them by less than 1 % (docs/separation.md).
constexpr std::size_t kStride = 29;

/// Every so many of a table's fitted cells, and which those are.
struct Part {
  CellTable table;
  std::vector<std::size_t> cells;
};

Part every_cell_of(const CellTable& table) {
  Part part;
  part.table.grid = table.grid;
  std::size_t next = 0;
  for (std::size_t group = 0; group < table.grid.angular_size(); ++group) {
    part.table.begin.push_back(static_cast<std::uint32_t>(part.cells.size()));
    for (; next < table.begin[group + 1]; next += kStride) {
      part.cells.push_back(next);
      part.table.cell.push_back(table.cell[next]);
      part.table.cos_i.push_back(table.cos_i[next]);
      part.table.cos_o.push_back(table.cos_o[next]);
      part.table.weight.push_back(table.weight[next]);
    }
  }
  part.table.begin.push_back(static_cast<std::uint32_t>(part.cells.size()));
  return part;
}

/// f̂ at one wavelength.
float value_at(const MeasuredBrdf& measured, const CellTable& table, std::size_t cell, std::size_t k) {
  double sum = 0;
  for (std::size_t i = table.node_begin[cell]; i < table.node_begin[cell + 1]; ++i) {
    sum += double(table.node_weight[i]) * double(measured.spectrum(table.node_row[i])[k]);
  }
  return static_cast<float>(sum / double(table.weight[cell]));
}

}  // namespace

std::vector<float> fit_analytic_spectra(const MeasuredBrdf& measured, const CellTable& table,
                                        const AnalyticFit& achromatic, const SeparationOptions& options) {
  const std::size_t n = measured.axis().size();
  const Part part = every_cell_of(table);
  std::vector<float> parameters(4 * n);
  parallel_chunks(n, [&](std::size_t k) {
    CellTable at_k = part.table;
    at_k.mean.reserve(part.cells.size());
    for (std::size_t cell : part.cells) at_k.mean.push_back(value_at(measured, table, cell, k));
    const AnalyticFit fit = refine_analytic(at_k, options, achromatic);
    parameters[k] = static_cast<float>(fit.albedo_d);
    parameters[n + k] = static_cast<float>(fit.rho_0);
    parameters[2 * n + k] = static_cast<float>(fit.f_0);
    parameters[3 * n + k] = static_cast<float>(fit.alpha);
  });
  return parameters;
}

}  // namespace spectrace
