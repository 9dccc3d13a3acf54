// SPDX-License-Identifier: Apache-2.0
#include "core/image/metrics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

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

/// One channel of an image, and how wide its rows are.
struct Plane {
  int width = 0, height = 0;
  std::vector<float> values;

  Plane(const Image& image, std::size_t channel) : width(image.width), height(image.height) {
    values.reserve(std::size_t(width) * std::size_t(height));
    for (std::size_t i = channel; i < image.data.size(); i += image.channels.size()) {
      values.push_back(image.data[i]);
    }
  }
};

/// The mean over all window positions inside the image.
double mean_ssim(const Plane& reference, const Plane& test, double data_range) {
  if (reference.width < kSsimWindow || reference.height < kSsimWindow) return kNan;
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
    const float* r_row = &reference.values[std::size_t(y) * reference.width];
    const float* t_row = &test.values[std::size_t(y) * reference.width];
    for (int x = 0; x < columns; ++x) {
      for (int i = 0; i < kSsimWindow; ++i) {
        const double r = r_row[x + i], t = t_row[x + i], w = weights[i];
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
  return sum / (double(columns) * double(reference.height - kSsimWindow + 1));
}

bool all_finite(const Image& image, std::span<const std::size_t> channels) {
  for (std::size_t pixel = 0; pixel < image.data.size(); pixel += image.channels.size()) {
    for (const std::size_t c : channels) {
      if (!std::isfinite(image.data[pixel + c])) return false;
    }
  }
  return true;
}

double used_data_range(const Image& reference, std::span<const std::size_t> channels,
                       const MetricOptions& options) {
  if (options.data_range > 0) return options.data_range;
  float peak = 0;
  for (std::size_t pixel = 0; pixel < reference.data.size(); pixel += reference.channels.size()) {
    for (const std::size_t c : channels) peak = std::max(peak, reference.data[pixel + c]);
  }
  return peak > 0 ? peak : 1;
}

double psnr_db(double data_range, double mse) { return 10 * std::log10(data_range * data_range / mse); }

Metrics compare_planes(const Plane& reference, const Plane& test, double data_range,
                       const MetricOptions& options) {
  Metrics m;
  for (std::size_t i = 0; i < reference.values.size(); ++i) {
    const double r = reference.values[i], difference = test.values[i] - r;
    const double square = difference * difference, magnitude = std::abs(difference);
    m.mse += square;
    m.mae += magnitude;
    m.rel_mse += square / (r * r + options.epsilon);
    m.mape += magnitude / (std::abs(r) + options.mape_floor);
    m.max_abs = std::max(m.max_abs, magnitude);
  }
  const double n = static_cast<double>(reference.values.size());
  for (double* sum : {&m.mse, &m.mae, &m.rel_mse, &m.mape}) *sum /= n;
  m.data_range = data_range;
  m.psnr_db = psnr_db(data_range, m.mse);
  m.ssim = mean_ssim(reference, test, data_range);
  return m;
}

/// All channels have as many pixels, so that means of channels are means of all values.
Metrics together(std::span<const Metrics> each, double data_range) {
  Metrics m;
  for (const Metrics& channel : each) {
    m.mse += channel.mse;
    m.mae += channel.mae;
    m.rel_mse += channel.rel_mse;
    m.mape += channel.mape;
    m.ssim += channel.ssim;
    m.max_abs = std::max(m.max_abs, channel.max_abs);
  }
  const double n = static_cast<double>(each.size());
  for (double* sum : {&m.mse, &m.mae, &m.rel_mse, &m.mape, &m.ssim}) *sum /= n;
  m.data_range = data_range;
  m.psnr_db = psnr_db(data_range, m.mse);
  return m;
}

constexpr Metrics kNotFinite{.finite = false,
                             .mse = kNan,
                             .mae = kNan,
                             .rel_mse = kNan,
                             .mape = kNan,
                             .psnr_db = kNan,
                             .ssim = kNan,
                             .max_abs = kNan,
                             .data_range = kNan};

}  // namespace

ChannelMetrics compare_channels(const Image& reference, std::span<const std::size_t> reference_channels,
                                const Image& test, std::span<const std::size_t> test_channels,
                                const MetricOptions& options) {
  SPECTRACE_CHECK(reference.width == test.width && reference.height == test.height);
  SPECTRACE_CHECK(reference_channels.size() == test_channels.size() && !reference_channels.empty() &&
                  !reference.data.empty());
  const std::size_t n = reference_channels.size();
  if (!all_finite(reference, reference_channels) || !all_finite(test, test_channels)) {
    return {kNotFinite, std::vector<Metrics>(n, kNotFinite)};
  }
  const double data_range = used_data_range(reference, reference_channels, options);
  ChannelMetrics result;
  for (std::size_t c = 0; c < n; ++c) {
    result.each.push_back(compare_planes(Plane(reference, reference_channels[c]),
                                         Plane(test, test_channels[c]), data_range, options));
  }
  result.together = together(result.each, data_range);
  return result;
}

Metrics compare_images(const Image& reference, const Image& test, const MetricOptions& options) {
  SPECTRACE_CHECK(reference.channels.size() == test.channels.size());
  std::vector<std::size_t> all(reference.channels.size());
  std::iota(all.begin(), all.end(), std::size_t(0));
  return compare_channels(reference, all, test, all, options).together;
}

}  // namespace spectrace
