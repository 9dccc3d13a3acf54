// SPDX-License-Identifier: Apache-2.0
// eq. 18: the colours of both lobes, two non-negative unknowns for each wavelength.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "separation/fast_log.h"
#include "separation/parallel.h"
#include "separation/wavelength_block.h"

namespace spectrace {

template <int B>
struct TwoLobes {
  std::array<float, B> s_d{}, s_s{};
};

/// Half the sum of squares of eq. 18 for each of B wavelengths, with its derivatives (Gauss-Newton).
template <int B>
struct TwoLobeSums {
  std::array<double, B> cost{}, g_d{}, g_s{}, h_dd{}, h_ds{}, h_ss{};

  void add(const TwoLobeSums& o) {
    for (int k = 0; k < B; ++k) {
      cost[k] += o.cost[k];
      g_d[k] += o.g_d[k], g_s[k] += o.g_s[k];
      h_dd[k] += o.h_dd[k], h_ds[k] += o.h_ds[k], h_ss[k] += o.h_ss[k];
    }
  }
};

template <int B>
TwoLobeSums<B> two_lobe_sums(const CellTable& table, const LobeWeights& lobes,
                             const WavelengthBlock<B>& block, double epsilon, const TwoLobes<B>& at) {
  const auto n_h = std::size_t(table.grid.n_theta_h), n_d = std::size_t(table.grid.n_theta_d);
  const auto eps = static_cast<float>(epsilon);
  std::vector<TwoLobeSums<B>> slices(n_h);
  parallel_chunks(n_h, [&](std::size_t h) {
    for (std::size_t group = h * n_d; group < (h + 1) * n_d; ++group) {
      // Single precision over one group of at most 180 cells, double beyond.
      std::array<float, B> cost{}, g_d{}, g_s{}, h_dd{}, h_ds{}, h_ss{};
      for (std::size_t i = table.begin[group]; i < table.begin[group + 1]; ++i) {
        const float a = lobes.diffuse[i], b = lobes.specular[i];
        const float* x = block.row(i);
        for (int k = 0; k < B; ++k) {
          const float inverse = 1 / (at.s_d[k] * a + at.s_s[k] * b + eps);
          const float r = fast_log((x[k] + eps) * inverse), u_d = a * inverse, u_s = b * inverse;
          cost[k] += r * r;
          g_d[k] += r * u_d;
          g_s[k] += r * u_s;
          h_dd[k] += u_d * u_d;
          h_ds[k] += u_d * u_s;
          h_ss[k] += u_s * u_s;
        }
      }
      TwoLobeSums<B>& sums = slices[h];
      for (int k = 0; k < B; ++k) {
        sums.cost[k] += double(cost[k]) / 2;
        sums.g_d[k] -= double(g_d[k]), sums.g_s[k] -= double(g_s[k]);
        sums.h_dd[k] += double(h_dd[k]), sums.h_ds[k] += double(h_ds[k]), sums.h_ss[k] += double(h_ss[k]);
      }
    }
  });
  TwoLobeSums<B> total;
  for (const TwoLobeSums<B>& slice : slices) total.add(slice);
  return total;
}

/// The 2x2 normal equations at one point.
struct TwoLobeEquations {
  double g_d = 0, g_s = 0, h_dd = 0, h_ds = 0, h_ss = 0;
};
/// The step (in s_d, s_s) of damped Gauss-Newton that keeps both non-negative: of the four ways to hold none,
/// one or both at 0 the one that is optimal for the quadratic model.
std::array<double, 2> bounded_step(const TwoLobeEquations& e, double damping, double s_d, double s_s);

/// Levenberg-Marquardt with bounds for all wavelengths of a block at once. A lobe whose weights are all 0
/// keeps colour 0.
template <int B>
TwoLobes<B> fit_two_lobes(const CellTable& table, const LobeWeights& lobes, const WavelengthBlock<B>& block,
                          int count, double epsilon) {
  constexpr int kMaxIterations = 60;
  constexpr double kTolerance = 1e-6;  // relative step; the samples carry 1e-7 of float rounding
  constexpr double kFirstDamping = 1e-3, kSmallestDamping = 1e-9;

  TwoLobes<B> trial;
  trial.s_d.fill(1);
  trial.s_s.fill(1);
  TwoLobes<B> best = trial;
  std::array<TwoLobeEquations, B> equations{};
  std::array<double, B> best_cost{}, damping{};
  std::array<bool, B> converged{};
  best_cost.fill(std::numeric_limits<double>::infinity());
  damping.fill(kFirstDamping);
  int remaining = count;  // of a last block only so many wavelengths exist
  for (int k = count; k < B; ++k) converged[k] = true;
  for (int iteration = 0; iteration < kMaxIterations && remaining > 0; ++iteration) {
    const TwoLobeSums<B> sums = two_lobe_sums<B>(table, lobes, block, epsilon, trial);
    for (int k = 0; k < B; ++k) {
      if (converged[k]) continue;
      if (sums.cost[k] <= best_cost[k]) {
        best_cost[k] = sums.cost[k];
        best.s_d[k] = sums.h_dd[k] > 0 ? trial.s_d[k] : 0;
        best.s_s[k] = sums.h_ss[k] > 0 ? trial.s_s[k] : 0;
        equations[k] = {sums.g_d[k], sums.g_s[k], sums.h_dd[k], sums.h_ds[k], sums.h_ss[k]};
        damping[k] = std::max(damping[k] / 10, kSmallestDamping);
      } else {
        damping[k] *= 10;
      }
      const double s_d = double(best.s_d[k]), s_s = double(best.s_s[k]);
      const std::array<double, 2> step = bounded_step(equations[k], damping[k], s_d, s_s);
      trial.s_d[k] = static_cast<float>(s_d + step[0]);
      trial.s_s[k] = static_cast<float>(s_s + step[1]);
      converged[k] = std::abs(step[0]) + std::abs(step[1]) <= kTolerance * (s_d + s_s);
      if (converged[k]) --remaining;
    }
  }
  return best;
}

}  // namespace spectrace
