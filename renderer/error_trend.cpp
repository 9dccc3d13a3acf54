// SPDX-License-Identifier: Apache-2.0
#include "renderer/error_trend.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"

namespace spectrace {

namespace {
constexpr double kLeastExponent = 0.5, kMostExponent = 1.5;
}

double ErrorTrend::exponent() const {
  SPECTRACE_CHECK(!seen_.empty());
  const Measured& now = seen_.back();
  const auto before = std::find_if(seen_.rbegin(), seen_.rend(),
                                   [&](const Measured& m) { return m.samples <= now.samples / 2; });
  if (before == seen_.rend() || !(now.error > 0)) return kLeastExponent;
  const double slope = std::log(before->error / now.error) / std::log(now.samples / before->samples);
  return std::clamp(slope, kLeastExponent, kMostExponent);
}

double ErrorTrend::samples_for(double error) const {
  const double fall = exponent();
  return seen_.back().samples * std::pow(seen_.back().error / error, 1 / fall);
}

}  // namespace spectrace
