// SPDX-License-Identifier: Apache-2.0
// Where a BSDF is tested that cares for no particular wavelengths.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "core/math/math.h"
#include "materials/bsdf.h"

namespace spectrace::test {

inline const SampledWavelengths kLambda = [] {
  std::array<Float, kLanes> nm{}, pdf{};
  for (int i = 0; i < kLanes; ++i) nm[std::size_t(i)] = Float(420 + 80 * i);
  pdf.fill(1);
  return SampledWavelengths(nm, pdf);
}();
inline const ShadingPoint kAt{.lambda = kLambda};

inline Vec3 direction_deg(double theta_deg, double phi_deg) {
  const double theta = theta_deg * kPi64 / 180, phi = phi_deg * kPi64 / 180;
  return {Float(std::sin(theta) * std::cos(phi)), Float(std::sin(theta) * std::sin(phi)),
          Float(std::cos(theta))};
}

/// What a value or a weight may be.
inline bool is_valid(const SampledSpectrum& s) { return s.is_finite() && s.min() >= 0; }
inline bool is_valid(const BsdfValue& v) {
  return is_valid(v.value_cos) && std::isfinite(v.pdf) && v.pdf >= 0;
}
inline bool is_nothing(const BsdfValue& v) { return v.value_cos.is_zero() && v.pdf == 0; }

}  // namespace spectrace::test
