// SPDX-License-Identifier: Apache-2.0
#include "core/image/error_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/base/error.h"

namespace spectrace {

namespace {

/// Below, three points with scatter would promise errors for ever; above, no sequence falls (Owen 1997).
constexpr double kLeastExponent = 0.5, kMostExponent = 3;

struct Line {
  double slope = 0, offset = 0;
};

/// y = slope · x + offset, of which neither is below 0: Σ((slope x + offset) / y - 1)² is least. Where the
/// free optimum breaks a bound, the better of the two optima on the bounds.
Line fit_line(std::span<const std::array<double, 2>> points) {
  double xx = 0, x1 = 0, ones = 0, x = 0, one = 0;
  for (const auto& [px, py] : points) {
    const double a = px / py, b = 1 / py;
    xx += a * a;
    x1 += a * b;
    ones += b * b;
    x += a;
    one += b;
  }
  const double determinant = xx * ones - x1 * x1;
  if (determinant > 0) {
    const Line free{(x * ones - one * x1) / determinant, (one * xx - x * x1) / determinant};
    if (free.slope >= 0 && free.offset >= 0) return free;
  }
  // What is left of the sum of squares is n - (x² / xx) or n - (one² / ones).
  const bool no_offset = x * x * ones >= one * one * xx;
  return no_offset ? Line{x / xx, 0} : Line{0, one / ones};
}

/// A line through logarithms of samples and noise.
void fit_noise(std::span<const std::array<double, 2>> logs, ErrorModel& model) {
  if (logs.empty()) return;
  double mean_x = 0, mean_y = 0, xx = 0, xy = 0;
  for (const auto& [x, y] : logs) {
    mean_x += x / double(logs.size());
    mean_y += y / double(logs.size());
  }
  for (const auto& [x, y] : logs) {
    xx += (x - mean_x) * (x - mean_x);
    xy += (x - mean_x) * (y - mean_y);
  }
  if (xx > 0) model.exponent = std::clamp(-xy / xx, kLeastExponent, kMostExponent);
  model.noise = std::exp(mean_y + model.exponent * mean_x);
}

template <typename Term>
Estimate mean_over(const IndependentPair& test, const IndependentPair& reference, const Term& term) {
  const std::size_t count = test.first.data.size();
  for (const Image* other : {&test.second, &reference.first, &reference.second}) {
    SPECTRACE_CHECK(other->width == test.first.width && other->data.size() == count);
  }
  // A pixel's channels share their samples: it is pixels that are independent.
  const std::size_t channels = test.first.channels.size();
  SPECTRACE_CHECK(count >= 2 * channels);
  double sum = 0, squares = 0;
  for (std::size_t pixel = 0; pixel < count; pixel += channels) {
    double x = 0;
    for (std::size_t i = pixel; i < pixel + channels; ++i) {
      x += term(double(test.first.data[i]), double(test.second.data[i]), double(reference.first.data[i]),
                double(reference.second.data[i])) /
           double(channels);
    }
    sum += x;
    squares += x * x;
  }
  const double n = double(count / channels), mean = sum / n;
  return {mean, std::sqrt(std::max(0.0, squares / n - mean * mean) / (n - 1))};
}

}  // namespace

std::optional<double> ErrorModel::samples_for(double wanted) const {
  if (!(wanted > bias)) return std::nullopt;
  return std::max(1.0, std::pow(noise / (wanted - bias), 1 / exponent));
}

double ErrorModel::rel_mse(double samples) const { return noise * std::pow(samples, -exponent) + bias; }

Estimate bias_rel_mse(const IndependentPair& test, const IndependentPair& reference, double epsilon) {
  return mean_over(test, reference, [&](double a, double b, double r1, double r2) {
    const double r = (r1 + r2) / 2;
    return (a - r1) * (b - r2) / (r * r + epsilon);
  });
}

Estimate noise_rel_mse(const IndependentPair& reference, double epsilon) {
  return mean_over(reference, reference, [&](double r1, double r2, double, double) {
    const double r = (r1 + r2) / 2, half = (r1 - r2) / 2;
    return half * half / (r * r + epsilon);
  });
}

ErrorModel fit_error_model(std::span<const ErrorPoint> points, double bias, double reference) {
  const auto [least, most] =
      std::minmax_element(points.begin(), points.end(),
                          [](const ErrorPoint& a, const ErrorPoint& b) { return a.samples < b.samples; });
  SPECTRACE_CHECK(points.size() >= 2 && least->samples > 0 && least->samples < most->samples);
  ErrorModel model;
  model.bias = std::max(0.0, bias);
  std::vector<std::array<double, 2>> times, logs;
  for (const ErrorPoint& point : points) {
    SPECTRACE_CHECK(point.rel_mse > 0 && point.seconds > 0);
    times.push_back({point.samples, point.seconds});
    const double noise = point.rel_mse - model.bias - reference;
    if (noise > 0) logs.push_back({std::log(point.samples), std::log(noise)});
  }
  fit_noise(logs, model);
  const Line time = fit_line(times);
  model.start = time.offset;
  model.per_sample = time.slope;
  return model;
}

}  // namespace spectrace
