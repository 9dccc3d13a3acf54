// SPDX-License-Identifier: Apache-2.0
// One non-negative unknown of eqs. 18 to 20, for kStrip wavelengths side by side.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>

#include "separation/fast_log.h"

namespace spectrace {

/// Wavelengths that are solved side by side: one register of AVX-512, two of AVX2, four of SSE.
inline constexpr std::size_t kStrip = 16;
using Strip = std::array<float, kStrip>;

/// Over samples j, with r_j = ln(y_j + ε) - ln(s b_j + a_j + ε) and u_j = s b_j / (s b_j + a_j + ε) =
/// -∂r_j/∂(ln s):
template <typename T>
struct LogRootSums {
  std::array<T, kStrip> gradient{};     ///< Σ r_j u_j, minus half the derivative of Σ r_j² by ln s
  std::array<T, kStrip> slope{};        ///< of the gradient by ln s
  std::array<T, kStrip> curvature{};    ///< of the gradient by ln s: its second derivative
  std::array<T, kStrip> information{};  ///< Σ u_j²: how many samples' worth of data s is determined by

  template <typename U>
  void add(const LogRootSums<U>& o) {
    for (std::size_t k = 0; k < kStrip; ++k) {
      gradient[k] += T(o.gradient[k]);
      slope[k] += T(o.slope[k]);
      curvature[k] += T(o.curvature[k]);
      information[k] += T(o.information[k]);
    }
  }
};

/// Finds the zero of the gradient over ln s by Halley's method inside a shrinking bracket, or by Gauss-Newton
/// where that is far from it. The gradient is positive at s → 0 and negative at s → ∞ (y_j >= 0), so
/// there is one; where it lies below kLeast, or at `highest` or above, that end is tested: s becomes an exact
/// 0, or `highest`.
///
/// A prior holds s to `towards` where the samples say nothing: it counts `weight` samples where information
/// is 0 and fades as weight / (1 + information), so that it moves no well determined value.
class LogRoot {
 public:
  /// Only the first `count` of the unknowns are wanted.
  SPECTRACE_KERNEL LogRoot(const Strip& towards, int count, float weight, float epsilon, const Strip& highest)
      : weight_(weight), epsilon_(epsilon) {
    for (std::size_t k = 0; k < kStrip; ++k) {
      log_towards_[k] = fast_log(towards[k] + epsilon);
      s_[k] = std::clamp(towards[k], kStart, highest[k]);
      lowest_[k] = kLeast;
      highest_[k] = highest[k];
      low_[k] = 0;
      high_[k] = kNever;
      open_[k] = int(k) < count ? 1 : 0;
    }
  }

  /// Keeps the values, forgets the bracket: the samples are others now.
  void start_again(int count) {
    for (std::size_t k = 0; k < kStrip; ++k) {
      s_[k] = std::clamp(s_[k], lowest_[k], highest_[k]);
      low_[k] = 0;
      high_[k] = kNever;
      open_[k] = int(k) < count ? 1 : 0;
    }
    iterations_ = 0;
  }

  [[nodiscard]] SPECTRACE_KERNEL bool done() const {
    std::int32_t open = 0;
    for (std::size_t k = 0; k < kStrip; ++k) open |= open_[k];
    return open == 0 || iterations_ == kMaxIterations;
  }
  /// Where the next sums are wanted.
  [[nodiscard]] SPECTRACE_KERNEL const Strip& at() const { return s_; }
  [[nodiscard]] SPECTRACE_KERNEL Strip result() const {
    Strip s;
    for (std::size_t k = 0; k < kStrip; ++k) s[k] = s_[k] < kZero ? 0.0F : s_[k];
    return s;
  }

  /// Of those wanted, how many the iterations' limit has cut short.
  [[nodiscard]] int unfinished() const { return std::accumulate(open_.begin(), open_.end(), 0); }

  template <typename T>
  SPECTRACE_KERNEL void step(const LogRootSums<T>& sums) {
    ++iterations_;
    for (std::size_t k = 0; k < kStrip; ++k) advance(k, sums);
  }

 private:
  // The mean of s over the axis is about 1. Below kZero it is 0; kLeast is where that is tested.
  static constexpr float kLeast = 0.5e-4F, kZero = 1e-4F, kStart = 1e-2F;
  static constexpr float kNever = 1e30F;
  // Steps of ln s after which s is as good as can be: Halley's leaves an error of its cube, others a share of
  // themselves; the samples carry 1e-7 of float rounding.
  static constexpr float kLastHalley = 1e-2F, kLastStep = 1e-5F;
  static constexpr float kLongestStep = 2;
  // Where steps stay inside the bracket without closing it (seen where the fading prior bends the gradient),
  // bisection takes over, which alone needs 22 for the range.
  static constexpr int kPatience = 36, kMaxIterations = 60;

  template <typename T>
  SPECTRACE_KERNEL void advance(std::size_t k, const LogRootSums<T>& sums) {
    const float s = s_[k];
    // The prior acts on ln s itself, regularised as the samples are, with s measured in units of 1.
    const float u = s / (s + epsilon_);
    const float pull = weight_ / (1 + float(sums.information[k]));
    const float gradient = float(sums.gradient[k]) + pull * (log_towards_[k] - fast_log(s + epsilon_)) * u;
    const float slope = float(sums.slope[k]) - pull * u * u, curvature = float(sums.curvature[k]);
    const float information = float(sums.information[k]) + pull * u * u;

    const bool rises = gradient > 0;
    low_[k] = rises ? s : low_[k];
    high_[k] = rises ? high_[k] : s;
    // Where the gradient is near an extremum Halley's steps are short without being near the zero.
    const float bend = gradient * curvature, square = slope * slope;
    const bool is_convex = slope < 0 && std::abs(bend) < square;
    float change = is_convex ? -2 * gradient * slope / (is_convex ? 2 * square - bend : 1)
                             : gradient / (information > 0 ? information : 1);
    change = std::min(std::max(change, -kLongestStep), kLongestStep);
    // Where less than a sample's worth of data speaks, the fading prior bends the gradient as well.
    const bool is_cubic = is_convex && float(sums.information[k]) > 1;
    const bool is_last = std::abs(change) < (is_cubic ? kLastHalley : kLastStep);

    float next = s * fast_exp(change);
    // Beyond an end of the range that end is tried; beyond a tried value of the bracket its middle.
    next = std::min(std::max(next, lowest_[k]), highest_[k]);
    const bool inside = next > low_[k] && next < high_[k] && iterations_ <= kPatience;
    const bool at_end = (rises && s >= highest_[k]) || (!rises && s <= lowest_[k]);
    const float low = std::max(low_[k], lowest_[k]), high = std::min(high_[k], highest_[k]);
    const float middle = std::sqrt(low * high);
    const bool is_open = open_[k] != 0;
    const bool stays = at_end || gradient == 0 || high - low <= kLastStep * low;
    const float chosen = stays ? s : inside ? next : is_last ? s : middle;
    s_[k] = is_open ? chosen : s;
    open_[k] = is_open && !stays && !is_last ? 1 : 0;
  }

  float weight_, epsilon_;
  Strip log_towards_, s_, lowest_, highest_, low_, high_;
  std::array<std::int32_t, kStrip> open_;
  int iterations_ = 0;
};

}  // namespace spectrace
