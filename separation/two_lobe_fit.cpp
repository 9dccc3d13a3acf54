// SPDX-License-Identifier: Apache-2.0
#include "separation/two_lobe_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "separation/parallel.h"

namespace spectrace {
namespace {

/// Single precision over one (theta_h, theta_d), double beyond.
struct TermSums {
  std::array<double, kStrip> rr{}, r_d{}, r_s{}, dd{}, ds{}, ss{}, r_dd{}, r_ds{}, r_ss{};

  template <typename Terms>
  void add(const Terms& o) {
    const auto each = [](std::array<double, kStrip>& to, const auto& from) {
      for (std::size_t k = 0; k < kStrip; ++k) to[k] += double(from[k]);
    };
    each(rr, o.rr), each(r_d, o.r_d), each(r_s, o.r_s);
    each(dd, o.dd), each(ds, o.ds), each(ss, o.ss);
    each(r_dd, o.r_dd), each(r_ds, o.r_ds), each(r_ss, o.r_ss);
  }
};

/// ½ Σ r² has the second derivatives Σ (1 + r) u uᵀ; Gauss-Newton takes Σ u uᵀ.
TwoLobeEquations equations_of(const TermSums& t, std::size_t k) {
  TwoLobeEquations e{.g_d = -t.r_d[k], .g_s = -t.r_s[k], .h_dd = t.dd[k], .h_ds = t.ds[k], .h_ss = t.ss[k]};
  const double dd = t.dd[k] + t.r_dd[k], ds = t.ds[k] + t.r_ds[k], ss = t.ss[k] + t.r_ss[k];
  // Nearly singular equations are as bad as indefinite ones.
  constexpr double kLeastShare = 0.1;
  const bool is_convex = dd > kLeastShare * t.dd[k] && ss > kLeastShare * t.ss[k] &&
                         dd * ss - ds * ds > kLeastShare * (t.dd[k] * t.ss[k] - t.ds[k] * t.ds[k]);
  if (is_convex) e.h_dd = dd, e.h_ds = ds, e.h_ss = ss;
  return e;
}

// Cells that find the neighbourhood of the solution: one in seven (7 divides no dimension of the paper's
// grid).
constexpr std::size_t kScoutStride = 7;

/// Improves `best` on every `stride`th cell until no wavelength's relative step would exceed `tolerance`,
/// were it not damped: a damped step is short for other reasons too.
void descend(const StripProblem& problem, std::size_t stride, int count, double tolerance, TwoLobes& best) {
  constexpr int kMaxIterations = 60;
  constexpr double kFirstDamping = 1e-3, kSmallestDamping = 1e-9;
  TwoLobes trial = best;
  std::array<TwoLobeEquations, kStrip> equations{};
  std::array<double, kStrip> best_cost{}, damping{};
  std::array<bool, kStrip> converged{};
  best_cost.fill(std::numeric_limits<double>::infinity());
  damping.fill(kFirstDamping);
  int remaining = count;
  for (int iteration = 0; iteration < kMaxIterations && remaining > 0; ++iteration) {
    const TwoLobeSums sums = two_lobe_sums(problem, stride, trial);
    for (std::size_t k = 0; k < std::size_t(count); ++k) {
      if (converged[k]) continue;
      if (sums.cost[k] <= best_cost[k]) {
        best_cost[k] = sums.cost[k];
        best.s_d[k] = sums.equations[k].h_dd > 0 ? trial.s_d[k] : 0;
        best.s_s[k] = sums.equations[k].h_ss > 0 ? trial.s_s[k] : 0;
        equations[k] = sums.equations[k];
        damping[k] = std::max(damping[k] / 10, kSmallestDamping);
      } else {
        damping[k] *= 10;
      }
      const double s_d = double(best.s_d[k]), s_s = double(best.s_s[k]);
      const std::array<double, 2> whole = bounded_step(equations[k], 0, s_d, s_s);
      converged[k] = std::abs(whole[0]) + std::abs(whole[1]) <= tolerance * (s_d + s_s);
      const std::array<double, 2> step =
          converged[k] ? whole : bounded_step(equations[k], damping[k], s_d, s_s);
      trial.s_d[k] = static_cast<float>(s_d + step[0]);
      trial.s_s[k] = static_cast<float>(s_s + step[1]);
      if (!converged[k]) continue;
      best.s_d[k] = trial.s_d[k], best.s_s[k] = trial.s_s[k];  // Newton's last step needs no confirmation
      --remaining;
    }
  }
  best.unfinished = remaining;
}

}  // namespace

std::array<double, 2> bounded_step(const TwoLobeEquations& e, double damping, double s_d, double s_s) {
  const double h_dd = e.h_dd * (1 + damping), h_ss = e.h_ss * (1 + damping);
  const auto model = [&](double d, double s) {
    return e.g_d * d + e.g_s * s + (h_dd * d * d + 2 * e.h_ds * d * s + h_ss * s * s) / 2;
  };
  // Along one unknown with the other's step fixed.
  const auto best_d = [&](double s) {
    return h_dd > 0 ? std::max(-(e.g_d + e.h_ds * s) / h_dd, -s_d) : -s_d;
  };
  const auto best_s = [&](double d) {
    return h_ss > 0 ? std::max(-(e.g_s + e.h_ds * d) / h_ss, -s_s) : -s_s;
  };

  std::array<double, 2> best{best_d(-s_s), -s_s};
  const std::array<double, 2> other{-s_d, best_s(-s_d)};
  if (model(other[0], other[1]) < model(best[0], best[1])) best = other;
  const double determinant = h_dd * h_ss - e.h_ds * e.h_ds;
  if (determinant > 0) {
    const double d = (e.h_ds * e.g_s - h_ss * e.g_d) / determinant;
    const double s = (e.h_ds * e.g_d - h_dd * e.g_s) / determinant;
    if (d >= -s_d && s >= -s_s) best = {d, s};  // the free optimum is the optimum
  }
  return best;
}

TwoLobeSums two_lobe_sums(const StripProblem& problem, std::size_t stride, const TwoLobes& at) {
  const CellTable& table = problem.table;
  const auto n_h = std::size_t(table.grid.n_theta_h), n_d = std::size_t(table.grid.n_theta_d);
  std::vector<TermSums> slices(n_h);
  parallel_chunks(n_h, [&](std::size_t h) {
    for (std::size_t group = h * n_d; group < (h + 1) * n_d; ++group) {
      slices[h].add(two_lobe_terms(problem, cells_of_group(table, group, stride), at.s_d, at.s_s));
    }
  });
  TermSums total;
  for (const TermSums& slice : slices) total.add(slice);
  TwoLobeSums sums;
  for (std::size_t k = 0; k < kStrip; ++k) {
    sums.cost[k] = total.rr[k] / 2;
    sums.equations[k] = equations_of(total, k);
  }
  return sums;
}

TwoLobes fit_two_lobes(const StripProblem& problem, int count) {
  // Relative steps after which Newton's method has found the part's solution as well as that of all needs,
  // and that of all to the rounding of the samples: the next steps would be these squared.
  constexpr double kScoutTolerance = 1e-2, kTolerance = 1e-3;
  TwoLobes best;
  best.s_d.fill(1);
  best.s_s.fill(1);
  descend(problem, kScoutStride, count, kScoutTolerance, best);
  descend(problem, 1, count, kTolerance, best);
  return best;
}

}  // namespace spectrace
