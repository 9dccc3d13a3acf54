// SPDX-License-Identifier: Apache-2.0
// Image metrics in double precision. Each states its constants; any non-finite pixel makes `finite` false.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/image/image.h"

namespace spectrace {

/// Width of SSIM's Gaussian window; also the smallest image that has an SSIM.
inline constexpr int kSsimWindow = 11;

/// An epsilon of relMSE that follows the image's scale: this times the square of the reference's mean.
inline constexpr double kRelativeEpsilon = 1e-2;

/// Constants of the metrics; every report prints them, since values differ between tools for them.
struct MetricOptions {
  double data_range = 0;     ///< peak of PSNR and L of SSIM; 0 = the reference's maximum value (1 where
                             ///< that is not positive)
  double epsilon = 1e-2;     ///< of relMSE: mean((t-r)² / (r² + epsilon))
  double mape_floor = 1e-2;  ///< of MAPE: mean(|t-r| / (|r| + floor)), as a fraction
};

struct Metrics {
  bool finite = true;  ///< no NaN or Inf in either image; otherwise all figures are NaN
  double mse = 0, mae = 0, rel_mse = 0, mape = 0;
  double psnr_db = 0;  ///< +inf for equal images
  double ssim = 0;     ///< 11x11 Gaussian, sigma 1.5, mean over channels, border of 5 pixels left out
  double max_abs = 0;
  double data_range = 0;  ///< as used
};

/// Both images: the same size and channel count (at least 11x11 for SSIM, else ssim is NaN); checked.
Metrics compare_images(const Image& reference, const Image& test, const MetricOptions& options = {});

struct ChannelMetrics {
  Metrics together;           ///< as compare_images() of these channels alone
  std::vector<Metrics> each;  ///< of one channel, with the data range of all of them
};
/// Of some channels, by their places in images that may have more: the first of the one against the first of
/// the other, and so on; at least one. Checked: the images' sizes, the number of channels.
ChannelMetrics compare_channels(const Image& reference, std::span<const std::size_t> reference_channels,
                                const Image& test, std::span<const std::size_t> test_channels,
                                const MetricOptions& options = {});

}  // namespace spectrace
