// SPDX-License-Identifier: Apache-2.0
// The values of a spectrum at this path's wavelengths: kLanes numbers, one SIMD register.
#pragma once

#include <array>
#include <cstddef>
#include <limits>

#include "core/base/float.h"

namespace spectrace {

/// Wavelengths a path carries: the one switch (ADR 0004).
inline constexpr int kLanes = 8;

/// Bytes. No more than the stack's own: in functions built for SSE2, GCC 12 has given the result of a call
/// less than the 32 that its type asked for, and a callee built for AVX2 relied on them.
inline constexpr std::size_t kLaneAlignment = 16;

struct alignas(kLaneAlignment) SampledSpectrum {
  std::array<Float, kLanes> v{};

  constexpr SampledSpectrum() = default;
  constexpr explicit SampledSpectrum(Float c) { v.fill(c); }

  constexpr Float& operator[](int i) { return v[i]; }
  constexpr Float operator[](int i) const { return v[i]; }

  constexpr SampledSpectrum& operator+=(const SampledSpectrum& o) { return *this = *this + o; }
  constexpr SampledSpectrum& operator-=(const SampledSpectrum& o) { return *this = *this - o; }
  constexpr SampledSpectrum& operator*=(const SampledSpectrum& o) { return *this = *this * o; }
  constexpr SampledSpectrum& operator*=(Float s) { return *this = *this * s; }
  friend constexpr SampledSpectrum operator+(const SampledSpectrum& a, const SampledSpectrum& b) {
    return by_lane([](Float x, Float y) { return x + y; }, a, b);
  }
  friend constexpr SampledSpectrum operator-(const SampledSpectrum& a, const SampledSpectrum& b) {
    return by_lane([](Float x, Float y) { return x - y; }, a, b);
  }
  friend constexpr SampledSpectrum operator*(const SampledSpectrum& a, const SampledSpectrum& b) {
    return by_lane([](Float x, Float y) { return x * y; }, a, b);
  }
  friend constexpr SampledSpectrum operator*(const SampledSpectrum& a, Float s) {
    return by_lane([s](Float x) { return x * s; }, a);
  }
  friend constexpr SampledSpectrum operator*(Float s, const SampledSpectrum& a) { return a * s; }
  friend constexpr SampledSpectrum operator/(const SampledSpectrum& a, Float s) { return a * (1 / s); }
  friend constexpr bool operator==(const SampledSpectrum&, const SampledSpectrum&) = default;

  [[nodiscard]] constexpr SampledSpectrum clamped_at_zero() const {
    return by_lane([](Float x) { return x > 0 ? x : Float(0); }, *this);
  }
  [[nodiscard]] constexpr Float max() const {
    return fold(v[0], [](Float most, Float x) { return x > most ? x : most; });
  }
  [[nodiscard]] constexpr Float min() const {
    return fold(v[0], [](Float least, Float x) { return x < least ? x : least; });
  }
  [[nodiscard]] constexpr Float average() const {
    return fold(Float(0), [](Float sum, Float x) { return sum + x; }) / kLanes;
  }
  [[nodiscard]] constexpr bool is_zero() const {
    return fold(0, [](int others, Float x) { return others + (x != 0 ? 1 : 0); }) == 0;
  }
  [[nodiscard]] constexpr bool is_finite() const {
    constexpr Float kMost = std::numeric_limits<Float>::max();
    return fold(0, [](int others, Float x) { return others + (x >= -kMost && x <= kMost ? 0 : 1); }) == 0;
  }

  /// f of each lane of its arguments. By pointers to plain arrays and without branches: compilers then make
  /// it operations of whole registers.
  template <typename F, typename... Spectra>
  static constexpr SampledSpectrum by_lane(const F& f, const Spectra&... spectra) {
    SampledSpectrum result;
    Float* const out = result.v.data();
    const auto apply = [&](const auto*... in) {
      for (int i = 0; i < kLanes; ++i) out[i] = f(in[i]...);
    };
    apply(spectra.v.data()...);
    return result;
  }

 private:
  template <typename T, typename F>
  [[nodiscard]] constexpr T fold(T start, const F& f) const {
    const Float* const in = v.data();
    for (int i = 0; i < kLanes; ++i) start = f(start, in[i]);
    return start;
  }
};

}  // namespace spectrace
