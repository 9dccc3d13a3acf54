// SPDX-License-Identifier: Apache-2.0
// Image metrics in double precision. Each states its constants; any non-finite pixel makes `finite` false.
#pragma once

#include "core/image/image.h"

namespace spectrace {

/// Width of SSIM's Gaussian window; also the smallest image that has an SSIM.
inline constexpr int kSsimWindow = 11;

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

}  // namespace spectrace
