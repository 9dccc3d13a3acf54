// SPDX-License-Identifier: Apache-2.0
#include "core/image/metrics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/base/error.h"

namespace spectrace {

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// Wang et al. 2004, "Image Quality Assessment: From Error Visibility to Structural Similarity", section III.
constexpr double kSsimK1 = 0.01;
constexpr double kSsimK2 = 0.03;
constexpr double kSsimSigma = 1.5;

using Window = std::array<double, kSsimWindow>;
/// Weighted means of r, t, r², t² and r t.
using Moments = std::array<double, 5>;

Window gaussian_window() {
  Window weights{};
  double sum = 0;
  for (int i = 0; i < kSsimWindow; ++i) {
    const double x = i - kSsimWindow / 2;
    weights[i] = std::exp(-x * x / (2 * kSsimSigma * kSsimSigma));
    sum += weights[i];
  }
  for (double& w : weights) w /= sum;
  return weights;
}

/// Wang et al. 2004, eq. 13.
double ssim_of(const Moments& m, double c1, double c2) {
  const double mean_product = m[0] * m[1], mean_r2 = m[0] * m[0], mean_t2 = m[1] * m[1];
  const double covariance = m[4] - mean_product;
  const double variances = (m[2] - mean_r2) + (m[3] - mean_t2);
  return (2 * mean_product + c1) * (2 * covariance + c2) / ((mean_r2 + mean_t2 + c1) * (variances + c2));
}

/// Sum over all window positions inside one channel.
double ssim_sum(const Image& reference, const Image& test, std::size_t channel, double data_range) {
  static const Window weights = gaussian_window();
  const double c1 = (kSsimK1 * data_range) * (kSsimK1 * data_range);
  const double c2 = (kSsimK2 * data_range) * (kSsimK2 * data_range);
  const int columns = reference.width - kSsimWindow + 1;
  // The last kSsimWindow rows, filtered along x; row y lies at y % kSsimWindow.
  std::array<std::vector<Moments>, kSsimWindow> rows;
  double sum = 0;
  for (int y = 0; y < reference.height; ++y) {
    std::vector<Moments>& row = rows[y % kSsimWindow];
    row.assign(columns, Moments{});
    for (int x = 0; x < columns; ++x) {
      for (int i = 0; i < kSsimWindow; ++i) {
        const double r = reference.at(x + i, y, channel), t = test.at(x + i, y, channel), w = weights[i];
        row[x][0] += w * r;
        row[x][1] += w * t;
        row[x][2] += w * r * r;
        row[x][3] += w * t * t;
        row[x][4] += w * r * t;
      }
    }
    if (y < kSsimWindow - 1) continue;
    for (int x = 0; x < columns; ++x) {
      Moments moments{};
      for (int i = 0; i < kSsimWindow; ++i) {
        const Moments& filtered = rows[(y - kSsimWindow + 1 + i) % kSsimWindow][x];
        for (std::size_t k = 0; k < moments.size(); ++k) moments[k] += weights[i] * filtered[k];
      }
      sum += ssim_of(moments, c1, c2);
    }
  }
  return sum;
}

double mean_ssim(const Image& reference, const Image& test, double data_range) {
  if (reference.width < kSsimWindow || reference.height < kSsimWindow) return kNan;
  double sum = 0;
  for (std::size_t c = 0; c < reference.channels.size(); ++c) sum += ssim_sum(reference, test, c, data_range);
  const double positions =
      double(reference.width - kSsimWindow + 1) * double(reference.height - kSsimWindow + 1);
  return sum / (positions * static_cast<double>(reference.channels.size()));
}

bool all_finite(const Image& image) {
  return std::all_of(image.data.begin(), image.data.end(), [](float x) { return std::isfinite(x); });
}

double used_data_range(const Image& reference, const MetricOptions& options) {
  if (options.data_range > 0) return options.data_range;
  const float peak = *std::max_element(reference.data.begin(), reference.data.end());
  return peak > 0 ? peak : 1;
}

}  // namespace

Metrics compare_images(const Image& reference, const Image& test, const MetricOptions& options) {
  SPECTRACE_CHECK(reference.width == test.width && reference.height == test.height);
  SPECTRACE_CHECK(reference.channels.size() == test.channels.size() && !reference.data.empty());
  Metrics m;
  if (!all_finite(reference) || !all_finite(test)) {
    return {.finite = false,
            .mse = kNan,
            .mae = kNan,
            .rel_mse = kNan,
            .mape = kNan,
            .psnr_db = kNan,
            .ssim = kNan,
            .max_abs = kNan,
            .data_range = kNan};
  }
  for (std::size_t i = 0; i < reference.data.size(); ++i) {
    const double r = reference.data[i], difference = test.data[i] - r;
    const double square = difference * difference, magnitude = std::abs(difference);
    m.mse += square;
    m.mae += magnitude;
    m.rel_mse += square / (r * r + options.epsilon);
    m.mape += magnitude / (std::abs(r) + options.mape_floor);
    m.max_abs = std::max(m.max_abs, magnitude);
  }
  const double n = static_cast<double>(reference.data.size());
  for (double* sum : {&m.mse, &m.mae, &m.rel_mse, &m.mape}) *sum /= n;
  m.data_range = used_data_range(reference, options);
  m.psnr_db = 10 * std::log10(m.data_range * m.data_range / m.mse);
  m.ssim = mean_ssim(reference, test, m.data_range);
  return m;
}

}  // namespace spectrace
