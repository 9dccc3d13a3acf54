// SPDX-License-Identifier: Apache-2.0
#include "core/image/z_test.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/base/error.h"

namespace spectrace {

namespace {

/// Sums over one channel.
struct Bias {
  double difference = 0, variance = 0;
};

double z_of(double difference, double variance) {
  if (difference == 0 && variance >= 0) return 0;  // also where nothing varies
  return difference / std::sqrt(variance);
}

}  // namespace

double z_threshold(double alpha, std::size_t tests) {
  SPECTRACE_CHECK(alpha > 0 && alpha < 1 && tests > 0);
  // 1 - (1 - alpha)^(1/n), without the cancellation that a large n brings.
  const double of_one = -std::expm1(std::log1p(-alpha) / double(tests));
  double below = 0, above = 40;  // erfc(40 / sqrt 2) is below the smallest double
  for (int i = 0; i < 100; ++i) {
    const double middle = (below + above) / 2;
    (std::erfc(middle / std::numbers::sqrt2) > of_one ? below : above) = middle;
  }
  return above;
}

ZTestResult z_test(const Image& reference, const Image& reference_variance, const Image& test,
                   const Image& test_variance, std::size_t tests, const ZTestOptions& options) {
  const std::size_t n = reference.channels.size();
  const bool has_noise = !test_variance.data.empty();
  SPECTRACE_CHECK(reference.width == test.width && !reference.data.empty() &&
                  reference_variance.data.size() == reference.data.size() &&
                  test.data.size() == reference.data.size() &&
                  (!has_noise || test_variance.data.size() == reference.data.size()));
  SPECTRACE_CHECK(tests >= reference.data.size());
  ZTestResult result{.threshold = z_threshold(options.alpha, tests), .mean_z = {}, .z = {}};
  result.z = Image(reference.width, reference.height, reference.channels);
  std::vector<Bias> biases(n);
  std::size_t accepted = 0;
  const std::size_t pixels = reference.data.size() / n;
  for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
    bool accepts = true;
    for (std::size_t c = 0; c < n; ++c) {
      const std::size_t i = pixel * n + c;
      const double r = reference.data[i], t = test.data[i];
      const double round_off = kZTestRoundOff * std::max(std::abs(r), std::abs(t));
      const double variance = double(reference_variance.data[i]) +
                              (has_noise ? double(test_variance.data[i]) : 0.0) + round_off * round_off;
      const double z = z_of(t - r, variance);
      result.z.data[i] = static_cast<float>(z);
      biases[c].difference += t - r;
      biases[c].variance += variance;
      const double magnitude = std::isnan(z) ? std::numeric_limits<double>::infinity() : std::abs(z);
      accepts = accepts && magnitude <= result.threshold;
      if (magnitude > result.largest_z) {
        result.largest_z = magnitude;
        result.x = static_cast<int>(pixel % std::size_t(reference.width));
        result.y = static_cast<int>(pixel / std::size_t(reference.width));
      }
    }
    accepted += accepts ? 1 : 0;
  }
  result.accepted_share = double(accepted) / double(pixels);
  for (const Bias& bias : biases) result.mean_z.push_back(z_of(bias.difference, bias.variance));
  const auto is_small = [&](double z) { return std::abs(z) <= options.mean_z; };
  result.passes = result.accepted_share >= options.accepted &&
                  (options.mean_z == 0 || std::all_of(result.mean_z.begin(), result.mean_z.end(), is_small));
  return result;
}

}  // namespace spectrace
