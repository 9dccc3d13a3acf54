// SPDX-License-Identifier: Apache-2.0
// eq. 18: the colours of both lobes, two non-negative unknowns for each wavelength.
#pragma once

#include <array>
#include <vector>

#include "separation/spectral_sums.h"

namespace spectrace {

struct TwoLobes {
  Strip s_d{}, s_s{};
  int unfinished = 0;  ///< wavelengths that the iterations' limit has cut short
};

/// The 2x2 normal equations at one point.
struct TwoLobeEquations {
  double g_d = 0, g_s = 0, h_dd = 0, h_ds = 0, h_ss = 0;
};
/// The step (in s_d, s_s) of the damped quadratic model that keeps both non-negative: of the four ways to
/// hold none, one or both at 0 the one that is optimal. `h` as of Gauss-Newton, or any positive definite one.
std::array<double, 2> bounded_step(const TwoLobeEquations& e, double damping, double s_d, double s_s);

/// Half the sum of squares of eq. 18 for each wavelength of a strip, with its derivatives.
struct TwoLobeSums {
  std::array<double, kStrip> cost{};
  std::array<TwoLobeEquations, kStrip> equations{};  ///< Newton's where they are positive definite
};
TwoLobeSums two_lobe_sums(const StripProblem& problem, std::size_t stride, const TwoLobes& at);

/// Levenberg-Marquardt with bounds for all wavelengths of a strip at once: on a part of the cells, then from
/// there on all of them. A lobe whose weights are all 0 keeps colour 0. Only the first `count` are wanted.
TwoLobes fit_two_lobes(const StripProblem& problem, int count);

}  // namespace spectrace
