// SPDX-License-Identifier: Apache-2.0
// Do two noisy images estimate the same one? A z-test in every channel of every pixel.
#pragma once

#include <cstddef>
#include <vector>

#include "core/image/image.h"

namespace spectrace {

struct ZTestOptions {
  /// Chance that a single one of all tests rejects although the images estimate the same: in (0, 1).
  double alpha = 0.01;
  /// Share of pixels that must accept. Not all: noise has heavier tails than a Gaussian, and variances are
  /// estimates themselves (Mitsuba 3's render tests ask for the same share).
  double accepted = 0.9975;
  /// Largest |z| of a channel's mean over the image; 0: reported, not judged.
  double mean_z = 0;
};

/// Relative standard deviation that every value has for being a float32 that was summed in some order: where
/// the estimated variance is zero, values may differ by this and no more. 16 units in the last place.
inline constexpr double kZTestRoundOff = 1e-6;

/// |z| above which one of `tests` two-sided tests rejects: erfc(z / sqrt 2) = 1 - (1 - alpha)^(1 / tests),
/// after Šidák.
[[nodiscard]] double z_threshold(double alpha, std::size_t tests);

struct ZTestResult {
  double threshold = 0;       ///< of |z|
  double accepted_share = 0;  ///< of pixels: those whose channels all accept
  double largest_z = 0;       ///< |z|; infinite where values differ without variance, or are not finite
  int x = 0, y = 0;           ///< where it is
  /// Of each channel the mean difference over its standard error: finds a bias that every pixel hides in its
  /// noise. Pixels are taken as independent, as a box filter leaves them.
  std::vector<double> mean_z;
  Image z;  ///< (test - reference) / standard deviation, the channels of the reference
  bool passes = false;
};

/// All images: the same size and channel count (checked). Variances are those of the means that the images
/// hold, not of one sample, and not below 0; `test_variance` has no pixels where the test image is without
/// noise. z = (t - r) / sqrt(var r + var t + (kZTestRoundOff · max(|r|, |t|))²), 0 where t = r.
/// `tests`: of all layers that are judged together, at least this one's pixels times channels.
[[nodiscard]] ZTestResult z_test(const Image& reference, const Image& reference_variance, const Image& test,
                                 const Image& test_variance, std::size_t tests,
                                 const ZTestOptions& options = {});

}  // namespace spectrace
