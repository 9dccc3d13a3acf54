// SPDX-License-Identifier: Apache-2.0
// What an image's error is made of: noise, which more samples take away, and bias, which they do not.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "core/image/image.h"

namespace spectrace {

/// Two renders of one thing that share no samples.
struct IndependentPair {
  const Image& first;
  const Image& second;
};

/// A mean over pixels and channels, and how well it is known.
struct Estimate {
  double value = 0, standard_error = 0;
};

/// The part of relMSE that is bias: mean((a - r1)(b - r2) / (r² + epsilon)) with r = (r1 + r2) / 2, to which
/// noise adds nothing on average, since no two of the four share any; so it may come out below 0. All of one
/// size and channel count, at least two pixels: checked.
[[nodiscard]] Estimate bias_rel_mse(const IndependentPair& test, const IndependentPair& reference,
                                    double epsilon);
/// The relMSE that noise leaves in the mean of the pair: mean((r1 - r2)² / 4 / (r² + epsilon)).
[[nodiscard]] Estimate noise_rel_mse(const IndependentPair& reference, double epsilon);

/// One render against a reference.
struct ErrorPoint {
  double samples = 0;  ///< a pixel, > 0
  double seconds = 0;  ///< of rendering, > 0
  double rel_mse = 0;  ///< against the reference, > 0
};

/// relMSE = noise · samples^-exponent + bias, seconds = start + per_sample · samples. Independent samples
/// have an exponent of 1; Owen-scrambled Sobol' points one of up to 3 where what they integrate is smooth
/// (Owen 1997).
struct ErrorModel {
  double noise = 0, exponent = 1, bias = 0;  ///< >= 0
  double start = 0, per_sample = 0;          ///< [s], >= 0

  [[nodiscard]] double rel_mse(double samples) const;
  [[nodiscard]] double seconds(double samples) const { return start + per_sample * samples; }
  /// Samples a pixel that bring relMSE down to this, at least 1; none do where the bias is larger.
  [[nodiscard]] std::optional<double> samples_for(double rel_mse) const;
};

/// Least squares of relative residuals, of logarithms for the noise, since errors and times span decades and
/// each is known to a share of itself. Points that are nothing but bias tell nothing of noise. `bias` as
/// above, `reference` the relMSE of the reference's own noise, which every point holds. Two points of
/// different samples at least: checked.
[[nodiscard]] ErrorModel fit_error_model(std::span<const ErrorPoint> points, double bias, double reference);

}  // namespace spectrace
