// SPDX-License-Identifier: Apache-2.0
// From the radiance of a path at its wavelengths to an estimate of X, Y and Z.
#pragma once

#include <array>

#include "core/spectra/color.h"

namespace spectrace {

/// Radiance of one path by lane, in double: the layers of a path then sum to its beauty to 1e-15.
struct LaneSums {
  std::array<double, kLanes> v{};

  LaneSums() = default;
  explicit LaneSums(const SampledSpectrum& radiance) {
    for (int lane = 0; lane < kLanes; ++lane) v[lane] = double(radiance[lane]);
  }
};

/// How much each lane of a path adds to X, Y and Z: (x̄, ȳ, z̄)(λ) / pdf / kLanes / ∫ȳ.
class LaneToXyz {
 public:
  /// Lanes of density 0 (terminated) add nothing.
  explicit LaneToXyz(const SampledWavelengths& lambda);
  /// Adds `sums` to `xyz`. False where a lane that counts is not finite, or negative unless
  /// `may_be_negative`.
  bool add(const LaneSums& sums, Xyz& xyz, bool may_be_negative = false) const;

 private:
  std::array<Xyz, kLanes> weight_{};
  std::array<bool, kLanes> counts_{};
};

}  // namespace spectrace
