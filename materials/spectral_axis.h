// SPDX-License-Identifier: Apache-2.0
// The last axis of a measured table: wavelengths, or the three channels of an RGB file.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/spectra/sampled_spectrum.h"
#include "core/spectra/sampled_wavelengths.h"

namespace spectrace {

/// Turns `size()` contiguous table values into the values at a path's wavelengths: linear between tabulated
/// wavelengths (the end values hold outside), or the linear RGB basis of core/spectra/rgb_uplift.h.
class SpectralAxis {
 public:
  SpectralAxis() = default;
  /// Strictly increasing [nm], at least one; checked.
  static SpectralAxis wavelengths(std::vector<float> lambda_nm);
  static SpectralAxis rgb();

  [[nodiscard]] bool is_rgb() const { return is_rgb_; }
  [[nodiscard]] std::size_t size() const { return is_rgb_ ? 3 : lambda_nm_.size(); }
  [[nodiscard]] std::span<const float> lambda_nm() const { return lambda_nm_; }  ///< empty for RGB

  /// Where each lane falls; computed once a lookup, then applied to any number of table rows.
  struct Lookup {
    std::array<SampledSpectrum, 3> rgb;       // only where is_rgb: the basis
    std::array<std::uint32_t, kLanes> index;  // only elsewhere: the lower neighbour
    std::array<Float, kLanes> fraction;       // and how far towards the upper one
    std::uint32_t upper = 0;                  // its distance: 1, or 0 for a single wavelength
    bool is_rgb = false;
    /// Σ over the axis of row[k] times this lane's weights. `row` has size() values.
    [[nodiscard]] SampledSpectrum apply(const float* row) const {
      if (is_rgb) return rgb[0] * Float(row[0]) + rgb[1] * Float(row[1]) + rgb[2] * Float(row[2]);
      SampledSpectrum out;
      for (int lane = 0; lane < kLanes; ++lane) {
        const float* const at = row + index[lane];
        out[lane] = (1 - fraction[lane]) * at[0] + fraction[lane] * at[upper];
      }
      return out;
    }
  };
  [[nodiscard]] Lookup lookup(const SampledWavelengths& lambda) const;

 private:
  std::vector<float> lambda_nm_;
  float inverse_step_per_nm_ = 0;  // > 0 where equally spaced
  bool is_rgb_ = false;
};

}  // namespace spectrace
