// SPDX-License-Identifier: Apache-2.0
// The values of a spectrum at this path's wavelengths: kLanes numbers, one SIMD register.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/float.h"

namespace spectrace {

/// Wavelengths a path carries: the one switch (ADR 0004).
inline constexpr int kLanes = 4;

struct alignas(kLanes * sizeof(Float)) SampledSpectrum {
  std::array<Float, kLanes> v{};

  constexpr SampledSpectrum() = default;
  constexpr explicit SampledSpectrum(Float c) { v.fill(c); }

  constexpr Float& operator[](int i) { return v[i]; }
  constexpr Float operator[](int i) const { return v[i]; }

  constexpr SampledSpectrum& operator+=(const SampledSpectrum& o) {
    for (int i = 0; i < kLanes; ++i) v[i] += o.v[i];
    return *this;
  }
  constexpr SampledSpectrum& operator-=(const SampledSpectrum& o) {
    for (int i = 0; i < kLanes; ++i) v[i] -= o.v[i];
    return *this;
  }
  constexpr SampledSpectrum& operator*=(const SampledSpectrum& o) {
    for (int i = 0; i < kLanes; ++i) v[i] *= o.v[i];
    return *this;
  }
  constexpr SampledSpectrum& operator*=(Float s) {
    for (int i = 0; i < kLanes; ++i) v[i] *= s;
    return *this;
  }
  friend constexpr SampledSpectrum operator+(SampledSpectrum a, const SampledSpectrum& b) { return a += b; }
  friend constexpr SampledSpectrum operator-(SampledSpectrum a, const SampledSpectrum& b) { return a -= b; }
  friend constexpr SampledSpectrum operator*(SampledSpectrum a, const SampledSpectrum& b) { return a *= b; }
  friend constexpr SampledSpectrum operator*(SampledSpectrum a, Float s) { return a *= s; }
  friend constexpr SampledSpectrum operator*(Float s, SampledSpectrum a) { return a *= s; }
  friend constexpr SampledSpectrum operator/(SampledSpectrum a, Float s) { return a *= (1 / s); }
  friend constexpr bool operator==(const SampledSpectrum&, const SampledSpectrum&) = default;

  [[nodiscard]] constexpr SampledSpectrum clamped_at_zero() const {
    SampledSpectrum out;
    for (int i = 0; i < kLanes; ++i) out[i] = v[i] > 0 ? v[i] : Float(0);
    return out;
  }
  [[nodiscard]] constexpr Float max() const { return *std::max_element(v.begin(), v.end()); }
  [[nodiscard]] constexpr Float min() const { return *std::min_element(v.begin(), v.end()); }
  [[nodiscard]] constexpr Float average() const {
    Float sum = 0;
    for (Float x : v) sum += x;
    return sum / kLanes;
  }
  [[nodiscard]] constexpr bool is_zero() const {
    return std::all_of(v.begin(), v.end(), [](Float x) { return x == 0; });
  }
  [[nodiscard]] bool is_finite() const {
    return std::all_of(v.begin(), v.end(), [](Float x) { return std::isfinite(x); });
  }
};

}  // namespace spectrace
