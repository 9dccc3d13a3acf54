// SPDX-License-Identifier: Apache-2.0
#include "separation/lobe_equations.h"

#include <algorithm>
#include <cmath>

#include "core/math/math.h"
#include "separation/instruction_set.h"
#include "separation/parallel.h"
#include "separation/precise_log.h"

namespace spectrace {
namespace {

constexpr std::size_t kLanes = 8;  // cells side by side: one register of AVX-512
// Cells of one partial sum: enough to be worth a task.
constexpr std::size_t kChunk = 4096;

using Lanes = std::array<double, kLanes>;

/// Entries (a, b), a <= b, of the triangle one after another.
constexpr std::size_t kEntries = kAugmented * (kAugmented + 1) / 2;
using Entries = std::array<Lanes, kEntries>;

/// Cells [first, first + kLanes) of `cells`, those from `end` on counted 0 times.
struct Batch {
  Lanes cos_i, cos_o, weight, sin2_h, schlick, log_data, counts;

  SPECTRACE_KERNEL Batch(const LobeCells& cells, std::size_t first, std::size_t end) {
    for (std::size_t k = 0; k < kLanes; ++k) {
      const std::size_t i = std::min(first + k, end - 1);
      cos_i[k] = double(cells.cos_i[i]), cos_o[k] = double(cells.cos_o[i]);
      weight[k] = double(cells.weight[i]);
      sin2_h[k] = double(cells.sin2_h[i]), schlick[k] = double(cells.schlick[i]);
      log_data[k] = double(cells.log_data[i]);
      counts[k] = first + k < end ? 1 : 0;
    }
  }
};

SPECTRACE_KERNEL inline void add_batch(const Batch& c, const LobeVector& x, double epsilon, double a2,
                                       Entries& sum) {
  std::array<Lanes, kAugmented> row;
  for (std::size_t k = 0; k < kLanes; ++k) {
    const double cos2 = 1 - c.sin2_h[k];
    const double t = a2 * cos2 + c.sin2_h[k];  // (a² - 1) cos² + 1 without cancellation
    // G(θ) / (2 cosθ) of eq. 15 is 1 / (cosθ + root), bounded by 1/a where G and cosθ both vanish.
    const double tan_i = a2 * (1 - c.cos_i[k] * c.cos_i[k]), tan_o = a2 * (1 - c.cos_o[k] * c.cos_o[k]);
    const double root_i = std::sqrt(c.cos_i[k] * c.cos_i[k] + tan_i);
    const double root_o = std::sqrt(c.cos_o[k] * c.cos_o[k] + tan_o);
    const double sum_i = c.cos_i[k] + root_i, sum_o = c.cos_o[k] + root_o;
    const double unit = a2 / (kPi64 * t * t * sum_i * sum_o) * c.weight[k];  // eqs. 14 and 15
    const double dlog_a = 2 - 4 * a2 * cos2 / t - tan_i / (root_i * sum_i) - tan_o / (root_o * sum_o);
    const double lambert = c.weight[k] / kPi64;
    const double specular = (x[1] + x[2] * c.schlick[k]) * unit;
    const double model = x[0] * lambert + specular + epsilon;
    const double scale = -c.counts[k] / model;  // r = ln(data) - ln(model)
    row[0][k] = scale * lambert;
    row[1][k] = scale * unit;
    row[2][k] = scale * unit * c.schlick[k];
    row[3][k] = scale * specular * dlog_a;
    row[4][k] = (c.log_data[k] - precise_log(model)) * c.counts[k];
  }
  std::size_t entry = 0;
  for (std::size_t a = 0; a < kAugmented; ++a) {
    for (std::size_t b = a; b < kAugmented; ++b, ++entry) {
      for (std::size_t k = 0; k < kLanes; ++k) sum[entry][k] += row[a][k] * row[b][k];
    }
  }
}

void add(Gram& to, const Gram& from) {
  for (std::size_t a = 0; a < kAugmented; ++a) {
    for (std::size_t b = a; b < kAugmented; ++b) to[a][b] += from[a][b];
  }
}

Gram chunk_gram(const LobeCells& cells, std::size_t first, std::size_t end, double epsilon,
                const LobeVector& x) {
  Entries sum{};
  const double a2 = std::exp(2 * x[3]);
  run_kernel([&]() SPECTRACE_KERNEL {
    for (std::size_t i = first; i < end; i += kLanes) add_batch(Batch(cells, i, end), x, epsilon, a2, sum);
  });
  Gram gram{};
  std::size_t entry = 0;
  for (std::size_t a = 0; a < kAugmented; ++a) {
    for (std::size_t b = a; b < kAugmented; ++b, ++entry) {
      for (double lane : sum[entry]) gram[a][b] += lane;
    }
  }
  return gram;
}

}  // namespace

LobeCells lobe_cells(const CellTable& table, double epsilon, std::size_t stride) {
  LobeCells cells;
  const auto n_d = std::size_t(table.grid.n_theta_d);
  std::size_t i = 0;
  for (std::size_t group = 0; group < table.grid.angular_size(); ++group) {
    const double sin_h = std::sin(table.grid.theta_h(double(group / n_d)));
    const double schlick = std::pow(1 - std::cos(table.grid.theta_d(double(group % n_d))), 5);
    for (; i < table.begin[group + 1]; i += stride) {
      cells.cos_i.push_back(table.cos_i[i]);
      cells.cos_o.push_back(table.cos_o[i]);
      cells.weight.push_back(table.weight[i]);
      cells.sin2_h.push_back(static_cast<float>(sin_h * sin_h));
      cells.schlick.push_back(static_cast<float>(schlick));
    }
  }
  cells.log_data.resize(cells.size());
  for (std::size_t c = 0; c < cells.size() && !table.mean.empty(); ++c) {
    const double data = double(table.mean[c * stride]) * double(cells.weight[c]) + epsilon;
    cells.log_data[c] = static_cast<float>(precise_log(data));
  }
  return cells;
}

LobeVector to_lobe(const AnalyticFit& fit) {
  return {fit.albedo_d, fit.rho_0 * fit.f_0, fit.rho_0 * (1 - fit.f_0),
          std::log(std::clamp(fit.alpha, kLeastAlpha, 1.0))};
}

AnalyticFit from_lobe(const LobeVector& x) {
  const double rho_0 = x[1] + x[2];
  return {.albedo_d = x[0], .rho_0 = rho_0, .f_0 = rho_0 > 0 ? x[1] / rho_0 : 0, .alpha = std::exp(x[3])};
}

Gram lobe_gram(const LobeCells& cells, double epsilon, const LobeVector& x) {
  Gram total{};
  for (std::size_t first = 0; first < cells.size(); first += kChunk) {
    add(total, chunk_gram(cells, first, std::min(first + kChunk, cells.size()), epsilon, x));
  }
  return total;
}

Gram lobe_gram_in_parallel(const LobeCells& cells, double epsilon, const LobeVector& x) {
  std::vector<Gram> chunks((cells.size() + kChunk - 1) / kChunk);
  parallel_chunks(chunks.size(), [&](std::size_t i) {
    chunks[i] = chunk_gram(cells, i * kChunk, std::min((i + 1) * kChunk, cells.size()), epsilon, x);
  });
  Gram total{};
  for (const Gram& chunk : chunks) add(total, chunk);
  return total;
}

}  // namespace spectrace
