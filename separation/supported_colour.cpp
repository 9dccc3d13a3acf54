// SPDX-License-Identifier: Apache-2.0
#include "separation/supported_colour.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "separation/fast_log.h"
#include "separation/instruction_set.h"
#include "separation/parallel.h"
#include "separation/split.h"

namespace spectrace {
namespace {

// As in step 1: one cell in seven (7 divides no dimension of the paper's grid).
constexpr std::size_t kStride = 7;

/// As split.cpp's energies, at each wavelength.
template <typename T>
struct Excess {
  std::array<T, kStrip> total{}, missing{}, slope{};  ///< slope: of missing by s_d
};

Excess<float> excess_of(const StripProblem& p, const CellRange& cells) {
  Excess<float> sums;
  run_kernel([&]() SPECTRACE_KERNEL {
    for (std::size_t i = cells.first; i < cells.end; i += cells.stride) {
      const float scale = (p.table.cos_i[i] + p.table.cos_o[i]) / p.table.weight[i], lobe = p.diffuse[i];
      const float* const data = p.log_data + i * kStrip;
      for (std::size_t k = 0; k < kStrip; ++k) {
        const float x = std::max(fast_wide_exp(data[k]) - p.epsilon, 0.0F), too_much = p.s_d[k] * lobe - x;
        sums.total[k] += scale * x;
        sums.missing[k] += too_much > 0 ? scale * too_much : 0.0F;
        sums.slope[k] += too_much > 0 ? scale * lobe : 0.0F;
      }
    }
  });
  return sums;
}

Excess<double> excess_of(const StripProblem& problem) {
  const HalfDifferenceGrid& grid = problem.table.grid;
  std::vector<Excess<double>> slices(std::size_t(grid.n_theta_h));
  parallel_chunks(slices.size(), [&](std::size_t h) {
    for (int d = 0; d < grid.n_theta_d; ++d) {
      const Excess<float> of =
          excess_of(problem, cells_of_group(problem.table, h * std::size_t(grid.n_theta_d) + d, kStride));
      const double solid_angle = node_measure(grid, h, std::size_t(d));
      for (std::size_t k = 0; k < kStrip; ++k) {
        slices[h].total[k] += solid_angle * double(of.total[k]);
        slices[h].missing[k] += solid_angle * double(of.missing[k]);
        slices[h].slope[k] += solid_angle * double(of.slope[k]);
      }
    }
  });
  Excess<double> sum;
  for (const Excess<double>& slice : slices) {
    for (std::size_t k = 0; k < kStrip; ++k) {
      sum.total[k] += slice.total[k], sum.missing[k] += slice.missing[k], sum.slope[k] += slice.slope[k];
    }
  }
  return sum;
}

}  // namespace

bool support_colour(StripProblem& problem, int count) {
  // What a lobe has too much is convex and piecewise linear in its colour: from above, Newton's steps never
  // pass the place where it is just supported, and a few reach it. 1 % of the bound is 0.003 % of the
  // material's light.
  constexpr int kSteps = 8;
  constexpr double kTolerance = 1e-2;
  bool was_lowered = false;
  for (int step = 0; step < kSteps; ++step) {
    const Excess<double> excess = excess_of(problem);
    bool lowers = false;
    for (std::size_t k = 0; k < std::size_t(count); ++k) {
      const double beyond = excess.missing[k] - kSupportedExcess * excess.total[k];
      if (!(beyond > kTolerance * kSupportedExcess * excess.total[k])) continue;
      problem.s_d[k] = static_cast<float>(std::max(double(problem.s_d[k]) - beyond / excess.slope[k], 0.0));
      lowers = was_lowered = true;
    }
    if (!lowers) break;
  }
  return was_lowered;
}

}  // namespace spectrace
