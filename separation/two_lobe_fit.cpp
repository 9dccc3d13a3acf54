// SPDX-License-Identifier: Apache-2.0
#include "separation/two_lobe_fit.h"

#include <algorithm>

namespace spectrace {

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

}  // namespace spectrace
