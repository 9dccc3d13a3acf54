// SPDX-License-Identifier: Apache-2.0
// A function of wavelength. What it means (reflectance, radiance, index of refraction) is its user's.
#pragma once

#include <array>
#include <filesystem>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "core/base/json.h"
#include "core/spectra/sampled_spectrum.h"
#include "core/spectra/sampled_wavelengths.h"

namespace spectrace {

using Rgb = std::array<double, 3>;  ///< linear sRGB primaries, D65 white
using Xyz = std::array<double, 3>;  ///< CIE 1931

struct ConstantSpectrum {
  Float value = 0;
  [[nodiscard]] Float at(Float) const { return value; }
};

/// Linear between samples; outside them the nearest end value holds (hard case H13).
class TabulatedSpectrum {
 public:
  /// `lambda_nm` strictly increasing, at least one entry, as many as `values`, all finite: checked.
  TabulatedSpectrum(std::vector<Float> lambda_nm, std::vector<Float> values);
  [[nodiscard]] Float at(Float lambda_nm) const;
  [[nodiscard]] SampledSpectrum sample(const SampledWavelengths& lambda) const;
  [[nodiscard]] std::span<const Float> lambda_nm() const { return lambda_nm_; }
  [[nodiscard]] std::span<const Float> values() const { return values_; }

 private:
  std::vector<Float> lambda_nm_, values_;
  Float inverse_step_per_nm_ = 0;  // > 0 where the samples are equally spaced: no search
};

/// Planck's law [W·m⁻²·sr⁻¹·nm⁻¹] at temperature T [K], times `scale`.
struct BlackbodySpectrum {
  Float kelvin = 6500;
  Float scale = 1;
  [[nodiscard]] Float at(Float lambda_nm) const;
};

/// scale · S(c0 t² + c1 t + c2) with S(x) = 1/2 + x / (2 sqrt(1 + x²)): Jakob & Hanika 2019, eqs. 2-3. In
/// [0, scale], smooth. t = (λ - 595 nm) / 235 nm is -1 and 1 at the ends of the visible range: with λ in
/// [nm], as there, the terms are large and cancel, which costs four of a float's seven digits.
struct SigmoidSpectrum {
  static constexpr Float kCenterNm = 595, kHalfWidthNm = 235;
  std::array<Float, 3> c{0, 0, 0};
  Float scale = 1;
  [[nodiscard]] Float at(Float lambda_nm) const;
  [[nodiscard]] SampledSpectrum sample(const SampledWavelengths& lambda) const;
};

/// A sigmoid times the illuminant D65, normalised so that rgb (1,1,1) has the colour and luminance of white:
/// what an RGB emission becomes.
struct RgbIlluminantSpectrum {
  SigmoidSpectrum sigmoid;
  [[nodiscard]] Float at(Float lambda_nm) const;
  [[nodiscard]] SampledSpectrum sample(const SampledWavelengths& lambda) const;
};

/// scale · n with n² = 1 + Σ b_i λ² / (λ² - c_i), λ in [µm], c in [µm²]; n = 1 where the sum is negative or
/// at a pole.
struct SellmeierSpectrum {
  std::array<Float, 3> b{};
  std::array<Float, 3> c_um2{};
  Float scale = 1;
  [[nodiscard]] Float at(Float lambda_nm) const;
};

/// scale · n with n = a + b / λ² + c / λ⁴, λ in [µm]: Cauchy's equation, good for glass in visible light.
struct CauchySpectrum {
  Float a = 1, b_um2 = 0, c_um4 = 0;
  Float scale = 1;
  [[nodiscard]] Float at(Float lambda_nm) const;
};

/// A closed sum of the above; immutable, copyable.
class Spectrum {
 public:
  using Variant = std::variant<ConstantSpectrum, TabulatedSpectrum, BlackbodySpectrum, SigmoidSpectrum,
                               RgbIlluminantSpectrum, SellmeierSpectrum, CauchySpectrum>;
  Spectrum() : v_(ConstantSpectrum{0}) {}
  template <typename T>
  requires std::is_constructible_v<Variant, T> Spectrum(T s)
      : v_(std::move(s)) {}  // NOLINT(google-explicit-constructor): a spectrum is any of its kinds
  static Spectrum constant(Float value) { return ConstantSpectrum{value}; }

  [[nodiscard]] Float at(Float lambda_nm) const;
  [[nodiscard]] SampledSpectrum sample(const SampledWavelengths& lambda) const;
  /// The same value at every wavelength?
  [[nodiscard]] bool is_constant() const;
  /// Upper bound over the range, to 1 nm: for light selection and validation.
  [[nodiscard]] Float max_over(WavelengthRange range) const;
  [[nodiscard]] Spectrum scaled(Float factor) const;

 private:
  Variant v_;
};

/// What an RGB triple means decides how it is uplifted.
enum class SpectrumRole {
  kReflectance,  ///< values in [0, 1]; RGB by a sigmoid
  kEmission,     ///< W·m⁻²·sr⁻¹·nm⁻¹, unbounded; RGB by a scaled sigmoid times D65
  kFactor,       ///< >= 0, unbounded, no unit: what light is multiplied by; RGB by a scaled sigmoid alone
  kUnbounded,    ///< index of refraction, extinction: RGB is refused
};

/// Reads the JSON forms of docs/scene-format.md: a number; {"rgb": [r,g,b]}; {"wavelengths_nm": [...],
/// "values": [...]}; {"file": "x.spd", "column": 1}; {"blackbody_K": T, "scale": s}; {"illuminant": "D65",
/// "scale": s} (1 at 560 nm; the names: core/spectra/illuminants.h); {"sellmeier": {"b": [3], "c_um2": [3]}};
/// {"cauchy": {"a": n, "b_um2": b, "c_um4": c}}. Every form takes "scale".
/// Problems are recorded in the document.
Spectrum parse_spectrum(const JsonValue& json, SpectrumRole role, const Spectrum& fallback = {});

/// Columns of text separated by blanks, tabs or commas: wavelength [nm], values; '#' begins a comment.
/// `column` = 1 takes the first after the wavelength. Throws InputError with line and column.
TabulatedSpectrum read_spd(const std::filesystem::path& file, int column = 1);

}  // namespace spectrace
