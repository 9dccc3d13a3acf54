// SPDX-License-Identifier: Apache-2.0
#include "separation/cell_table.h"

#include <algorithm>
#include <utility>

#include "materials/half_difference.h"
#include "separation/parallel.h"
#include "separation/reciprocal_pair.h"

namespace spectrace {
namespace {

/// Σ of the pair's rows times `row_mean`: the mean of q over the axis.
double mean_of(const ReciprocalPair& pair, const std::vector<float>& row_mean) {
  double q = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    for (int n = 0; n < pair.footprint[i].count; ++n) {
      q += pair.scale[i] * double(pair.footprint[i].weight[n]) * double(row_mean[pair.footprint[i].row[n]]);
    }
  }
  return q;
}

void add_fitted(CellTable& slice, std::size_t cell, const DirectionPair& directions,
                const ReciprocalPair& pair, double mean_q, const SeparationOptions& options) {
  const double cos_i = directions.wi.z, cos_o = directions.wo.z;
  const double weight = cosine_weight(cos_i, cos_o, options);
  slice.cell.push_back(static_cast<std::uint32_t>(cell));
  slice.cos_i.push_back(static_cast<float>(cos_i));
  slice.cos_o.push_back(static_cast<float>(cos_o));
  slice.weight.push_back(static_cast<float>(weight));
  slice.mean.push_back(static_cast<float>(mean_q / (cos_i + cos_o)));
  for (std::size_t i = 0; i < 2; ++i) {
    const double scale = pair.scale[i] * weight / (cos_i + cos_o);
    for (int n = 0; n < pair.footprint[i].count && scale > 0; ++n) {
      slice.node_row.push_back(pair.footprint[i].row[n]);
      slice.node_weight.push_back(static_cast<float>(scale * double(pair.footprint[i].weight[n])));
    }
  }
  slice.node_begin.push_back(static_cast<std::uint32_t>(slice.node_row.size()));
}

/// The cells of one theta_h: slices are filled in parallel and joined in order.
void fill_slice(const MeasuredBrdf& brdf, const SeparationOptions& options,
                const std::vector<float>& row_mean, int h, CellTable& slice, float* mean_q) {
  const HalfDifferenceGrid& grid = options.grid;
  slice.node_begin = {0};
  for (int d = 0; d < grid.n_theta_d; ++d) {
    slice.begin.push_back(static_cast<std::uint32_t>(slice.cell.size()));
    for (int p = 0; p < grid.n_phi_d; ++p) {
      const std::size_t cell = grid.index(h, d, p);
      const DirectionPair directions =
          from_half_difference({grid.theta_h(h), grid.theta_d(d), grid.phi_d(p)});
      mean_q[cell] = -1;
      if (!(directions.wo.z > 0 && directions.wi.z > 0)) {
        ++slice.counts.below_horizon;
        continue;
      }
      const ReciprocalPair pair = locate_pair(brdf, directions);
      const double q = mean_of(pair, row_mean);
      if (pair.any) mean_q[cell] = static_cast<float>(q);
      if (pair.measured) {
        ++slice.counts.measured;
        add_fitted(slice, cell, directions, pair, q, options);
      } else {
        ++(pair.extrapolated ? slice.counts.extrapolated : slice.counts.invalid);
      }
    }
  }
}

template <typename T>
void append(std::vector<T>& to, const std::vector<T>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

CellTable join(const HalfDifferenceGrid& grid, std::vector<CellTable>& slices, std::vector<float> mean_q) {
  CellTable table;
  table.grid = grid;
  table.mean_q = std::move(mean_q);
  table.counts.cells = grid.size();
  std::size_t cells = 0, nodes = 0;
  for (const CellTable& slice : slices) cells += slice.cell.size(), nodes += slice.node_row.size();
  table.node_row.reserve(nodes);
  table.node_weight.reserve(nodes);
  table.node_begin.reserve(cells + 1);
  for (CellTable& slice : slices) {
    const auto first_cell = static_cast<std::uint32_t>(table.cell.size());
    const auto first_node = static_cast<std::uint32_t>(table.node_row.size());
    for (std::uint32_t b : slice.begin) table.begin.push_back(first_cell + b);
    for (std::size_t i = 0; i + 1 < slice.node_begin.size(); ++i) {
      table.node_begin.push_back(first_node + slice.node_begin[i]);
    }
    append(table.cell, slice.cell);
    append(table.cos_i, slice.cos_i);
    append(table.cos_o, slice.cos_o);
    append(table.weight, slice.weight);
    append(table.mean, slice.mean);
    append(table.node_row, slice.node_row);
    append(table.node_weight, slice.node_weight);
    table.counts.below_horizon += slice.counts.below_horizon;
    table.counts.measured += slice.counts.measured;
    table.counts.extrapolated += slice.counts.extrapolated;
    table.counts.invalid += slice.counts.invalid;
    slice = {};
  }
  table.begin.push_back(static_cast<std::uint32_t>(table.cell.size()));
  table.node_begin.push_back(static_cast<std::uint32_t>(table.node_row.size()));
  return table;
}

/// The mean over the axis of each row of the measurement: it commutes with interpolation.
std::vector<float> row_means(const MeasuredBrdf& brdf) {
  const MeasuredTables& tables = brdf.tables();
  const std::size_t rows = tables.slices() * std::size_t(tables.table_size) * std::size_t(tables.table_size);
  const std::size_t n = brdf.axis().size();
  std::vector<float> means(rows);
  for (std::size_t r = 0; r < rows; ++r) {
    const float* row = brdf.spectrum(static_cast<std::uint32_t>(r));
    double sum = 0;
    for (std::size_t k = 0; k < n; ++k) sum += double(row[k]);
    means[r] = static_cast<float>(sum / double(n));
  }
  return means;
}

}  // namespace

double cosine_weight(double cos_i, double cos_o, const SeparationOptions& options) {
  const double cosines = options.weight == CosineWeight::kProduct ? cos_i * cos_o : std::max(cos_i, cos_o);
  return std::max(cosines, options.epsilon);
}

CellTable build_cell_table(const MeasuredBrdf& measured, const SeparationOptions& options) {
  const std::vector<float> means = row_means(measured);
  std::vector<CellTable> slices(std::size_t(options.grid.n_theta_h));
  std::vector<float> mean_q(options.grid.size());
  parallel_chunks(slices.size(), [&](std::size_t h) {
    fill_slice(measured, options, means, static_cast<int>(h), slices[h], mean_q.data());
  });
  return join(options.grid, slices, std::move(mean_q));
}

double node_measure(const HalfDifferenceGrid& grid, std::size_t h, std::size_t d) {
  const double at = double(h), theta_d = grid.theta_d(double(d));
  const double step_h = grid.theta_h(at + 0.5) - grid.theta_h(std::max(at - 0.5, 0.0));
  return std::sin(grid.theta_h(at)) * step_h * std::sin(theta_d) * std::cos(theta_d);
}

}  // namespace spectrace
