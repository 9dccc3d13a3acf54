// SPDX-License-Identifier: Apache-2.0
// The wavelength bins of a spectral image.
#pragma once

#include <cstddef>
#include <vector>

#include "core/spectra/sampled_wavelengths.h"

namespace spectrace {

/// `count` bins of equal width over `range`; a bin holds the mean spectral radiance over its width, or, with
/// `at_centers`, that at its centre (the reference mode: paths carry centres of bins only).
struct SpectralBins {
  WavelengthRange range;
  std::size_t count = 0;
  bool at_centers = false;

  [[nodiscard]] double width_nm() const { return double(range.width_nm()) / double(count); }
  [[nodiscard]] double center_nm(std::size_t bin) const {
    return double(range.min_nm) + (double(bin) + 0.5) * width_nm();
  }
  /// Of a wavelength in the range; the upper end belongs to the last bin. `count` outside.
  [[nodiscard]] std::size_t bin_of(Float lambda_nm) const {
    if (!(lambda_nm >= range.min_nm && lambda_nm <= range.max_nm)) return count;
    const auto bin = std::size_t(double(lambda_nm - range.min_nm) / width_nm());
    return bin < count ? bin : count - 1;
  }
  [[nodiscard]] std::vector<double> centers_nm() const {
    std::vector<double> centers(count);
    for (std::size_t bin = 0; bin < count; ++bin) centers[bin] = center_nm(bin);
    return centers;
  }
  friend constexpr bool operator==(const SpectralBins&, const SpectralBins&) = default;
};

}  // namespace spectrace
