// SPDX-License-Identifier: Apache-2.0
#include "materials/spectral_axis.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/spectra/rgb_uplift.h"

namespace spectrace {

namespace {

/// 1 / step where the guess lambda -> index is then off by at most one entry; 0 for unequal steps.
float inverse_equal_step(const std::vector<float>& lambda_nm) {
  if (lambda_nm.size() < 2) return 0;
  const float step = (lambda_nm.back() - lambda_nm.front()) / static_cast<float>(lambda_nm.size() - 1);
  for (std::size_t i = 0; i < lambda_nm.size(); ++i) {
    if (std::abs(lambda_nm[i] - (lambda_nm.front() + static_cast<float>(i) * step)) > step / 2) return 0;
  }
  return 1 / step;
}

}  // namespace

SpectralAxis SpectralAxis::wavelengths(std::vector<float> lambda_nm) {
  SPECTRACE_CHECK(!lambda_nm.empty());
  SPECTRACE_CHECK(std::is_sorted(lambda_nm.begin(), lambda_nm.end(), std::less_equal<>()));  // strictly
  SpectralAxis axis;
  axis.lambda_nm_ = std::move(lambda_nm);
  axis.inverse_step_per_nm_ = inverse_equal_step(axis.lambda_nm_);
  return axis;
}

SpectralAxis SpectralAxis::rgb() {
  SpectralAxis axis;
  axis.is_rgb_ = true;
  return axis;
}

SpectralAxis::Lookup SpectralAxis::lookup(const SampledWavelengths& lambda) const {
  Lookup out;
  out.is_rgb = is_rgb_;
  if (is_rgb_) {
    out.rgb = rgb_basis(lambda);
    return out;
  }
  const std::size_t n = lambda_nm_.size();
  if (n < 2) {  // one wavelength: grey
    out.index.fill(0);
    out.fraction.fill(0);
    return out;
  }
  out.upper = 1;
  const float* const first = lambda_nm_.data();
  for (int lane = 0; lane < kLanes; ++lane) {
    const float wanted = std::clamp(static_cast<float>(lambda.lambda_nm(lane)), first[0], first[n - 1]);
    std::size_t i = 0;
    if (inverse_step_per_nm_ > 0) {
      i = std::min(static_cast<std::size_t>((wanted - first[0]) * inverse_step_per_nm_), n - 2);
      if (i > 0 && wanted < first[i]) --i;
      if (i < n - 2 && wanted >= first[i + 1]) ++i;
    } else {
      i = std::clamp<std::size_t>(std::upper_bound(first, first + n, wanted) - first, 1, n - 1) - 1;
    }
    out.index[lane] = static_cast<std::uint32_t>(i);
    out.fraction[lane] = (Float(wanted) - first[i]) / (Float(first[i + 1]) - first[i]);
  }
  return out;
}

}  // namespace spectrace
