// SPDX-License-Identifier: Apache-2.0
// From the radiance of a path at its wavelengths to an estimate of X, Y and Z.
#pragma once

#include <array>
#include <cstdint>

#include "core/spectra/sampled_spectrum.h"
#include "core/spectra/sampled_wavelengths.h"

namespace spectrace {

/// Radiance of one path by lane, in double: so its layers sum to its beauty even where X, Y and Z nearly
/// cancel in a colour's G or B.
struct LaneSums {
  std::array<double, kLanes> v;  // not 0 by itself: paths have layers that most of them never light

  LaneSums& operator+=(const SampledSpectrum& radiance) {
    add([](Float x) { return double(x); }, radiance);
    return *this;
  }
  /// Adds f of the lanes of `spectra`.
  template <typename F, typename... Spectra>
  void add(const F& f, const Spectra&... spectra) {
    double* const sums = v.data();
    const auto apply = [&](const auto*... in) {
      for (int i = 0; i < kLanes; ++i) sums[i] += f(in[i]...);
    };
    apply(spectra.v.data()...);
  }
};

/// X, Y and Z of one path; the fourth fills the register and is 0.
using PathXyz = std::array<double, 4>;

/// How much each lane of a path adds to X, Y and Z: (x̄, ȳ, z̄)(λ) / pdf / kLanes / ∫ȳ.
class LaneToXyz {
 public:
  /// Lanes of density 0 (terminated) add nothing.
  explicit LaneToXyz(const SampledWavelengths& lambda);
  /// Adds `radiance` to `xyz`. False where a lane that counts is not finite, or negative unless
  /// `may_be_negative`.
  bool add(const LaneSums& radiance, PathXyz& xyz, bool may_be_negative = false) const;

 private:
  void weigh(const SampledWavelengths& lambda);

  alignas(kLaneAlignment) std::array<std::array<Float, 4>, kLanes> weights_{};
  std::array<std::int32_t, kLanes> counts_{};
};

}  // namespace spectrace
