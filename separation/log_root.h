// SPDX-License-Identifier: Apache-2.0
// One non-negative unknown of eqs. 19 and 20, for B wavelengths side by side.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "separation/fast_log.h"

namespace spectrace {

/// Over samples j, with r_j = ln(y_j + ε) - ln(s b_j + ε) and u_j = s b_j / (s b_j + ε) = -∂r_j/∂(ln s):
template <int B>
struct LogRootSums {
  std::array<double, B> gradient{};     ///< Σ r_j u_j, minus half the derivative of Σ r_j² by ln s
  std::array<double, B> information{};  ///< Σ u_j²: how many samples' worth of data s is determined by
};

/// Finds the zero of the gradient over σ = ln s by Gauss-Newton inside a shrinking bracket. The gradient is
/// positive at σ → -∞ and negative at σ → ∞ (y_j >= 0), so there is one; where every y_j is 0 and nothing
/// draws s up it runs to the lower end of the range, which becomes an exact 0.
///
/// A prior holds s to `towards` where the samples say nothing: it counts `weight` samples where information
/// is 0 and fades as weight / (1 + information), so that it moves no well determined value.
template <int B>
class LogRoot {
 public:
  /// Only the first `count` of the B unknowns are wanted; none leaves [0, highest].
  LogRoot(const std::array<float, B>& towards, int count, double weight, double epsilon,
          const std::array<float, B>& highest)
      : weight_(weight), epsilon_(epsilon), towards_(towards), remaining_(count) {
    for (int k = 0; k < B; ++k) {
      sigma_[k] = std::clamp(std::log(std::max(double(towards[k]), kSmallest)), std::log(kStart),
                             std::log(double(highest[k])));
      low_[k] = std::log(kSmallest);
      high_[k] = std::log(double(highest[k]));
      s_[k] = static_cast<float>(std::exp(sigma_[k]));
      converged_[k] = k >= count;
    }
  }

  [[nodiscard]] bool done() const { return remaining_ == 0 || iterations_ == kMaxIterations; }
  /// Where the next sums are wanted.
  [[nodiscard]] const std::array<float, B>& at() const { return s_; }

  void step(const LogRootSums<B>& sums) {
    ++iterations_;
    remaining_ = 0;
    for (int k = 0; k < B; ++k) {
      if (converged_[k]) continue;
      advance(k, sums.gradient[k], sums.information[k]);
      if (!converged_[k]) ++remaining_;
    }
  }

  [[nodiscard]] std::array<float, B> result() const {
    std::array<float, B> s = s_;
    for (float& x : s) x = double(x) < kZero ? 0.0F : x;
    return s;
  }

 private:
  // The mean of s over the axis is about 1. Below kZero it is 0.
  static constexpr double kSmallest = 1e-6, kZero = 1e-4, kStart = 1e-2;
  static constexpr double kTolerance = 1e-5;  // of ln s; the samples carry 1e-7 of float rounding
  static constexpr int kMaxIterations = 60;   // bisection alone needs 22 for the range

  void advance(int k, double gradient, double information) {
    const double s = double(s_[k]);
    // The prior acts on ln s itself, regularised as the samples are, with s measured in units of 1.
    const double pull = weight_ / (1 + information);
    gradient += pull * std::log((double(towards_[k]) + epsilon_) / (s + epsilon_)) * s / (s + epsilon_);
    information += pull * (s / (s + epsilon_)) * (s / (s + epsilon_));
    (gradient > 0 ? low_[k] : high_[k]) = sigma_[k];
    double next = sigma_[k] + (information > 0 ? gradient / information : 0);
    if (!(next > low_[k] && next < high_[k])) next = (low_[k] + high_[k]) / 2;
    converged_[k] = std::abs(next - sigma_[k]) < kTolerance || gradient == 0 || high_[k] < std::log(kZero);
    if (gradient != 0) sigma_[k] = next;
    s_[k] = static_cast<float>(std::exp(sigma_[k]));
  }

  double weight_, epsilon_;
  std::array<float, B> towards_, s_{};
  std::array<double, B> sigma_{}, low_{}, high_{};
  std::array<bool, B> converged_{};
  int remaining_, iterations_ = 0;
};

}  // namespace spectrace
