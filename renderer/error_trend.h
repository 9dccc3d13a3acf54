// SPDX-License-Identifier: Apache-2.0
// How an image's error falls while it is rendered, and so how many samples another error takes.
#pragma once

#include <vector>

namespace spectrace {

/// error = c · samples^-exponent, through the newest measurement and the last one with at most half its
/// samples.
class ErrorTrend {
 public:
  /// Samples a pixel, more than before, > 0; error >= 0.
  void add(double samples, double error) { seen_.push_back({samples, error}); }

  [[nodiscard]] bool is_known() const { return !seen_.empty(); }
  /// In [1/2, 3/2]: independent samples have 1/2, Owen-scrambled Sobol' points up to 3/2 where what they
  /// integrate is smooth (Owen 1997). 1/2 where there is too little to tell it from: that asks for too many
  /// samples, not too few.
  [[nodiscard]] double exponent() const;
  /// After one add() at least: checked. `error` > 0.
  [[nodiscard]] double samples_for(double error) const;

 private:
  struct Measured {
    double samples = 0, error = 0;
  };
  std::vector<Measured> seen_;
};

}  // namespace spectrace
