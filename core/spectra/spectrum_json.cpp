// SPDX-License-Identifier: Apache-2.0
// Spectra from JSON; the forms are documented in docs/scene-format.md.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>

#include "core/base/error.h"
#include "core/spectra/illuminants.h"
#include "core/spectra/rgb_uplift.h"
#include "core/spectra/spectrum.h"

namespace spectrace {
namespace {

// Far above anything physical, far enough below a float's limit for products along a path to stay finite.
constexpr double kLargest = 1e30;
// A reflectance may pass 1 by what "scale" and uplift round; 10 roundings of a float.
constexpr double kReflectanceSlack = 1e-6;
// Where values are checked: what any scene may ask for (docs/scene-format.md, range_nm).
constexpr WavelengthRange kCheckedRange{.min_nm = 100, .max_nm = 10000};
constexpr std::size_t kMaxSamples = std::size_t(1) << 20;

NumberRange value_range(SpectrumRole role, double scale) {
  switch (role) {
    case SpectrumRole::kReflectance:
      return {.min = 0, .max = scale > 1e-30 ? 1 / scale : kLargest};
    case SpectrumRole::kEmission:
    case SpectrumRole::kFactor:
      return {.min = 0, .max = kLargest};
    case SpectrumRole::kUnbounded:
      break;
  }
  return {.min = -kLargest, .max = kLargest};
}

using MaybeSpectrum = std::optional<Spectrum>;

MaybeSpectrum parse_rgb(const JsonValue& json, SpectrumRole role, NumberRange range) {
  if (role == SpectrumRole::kUnbounded) {
    json.error(
        "a colour has no meaning here: give a number, \"wavelengths_nm\" and \"values\", or a \"file\"");
    return std::nullopt;
  }
  const std::vector<double> v = json.numbers(3, 3, range);
  if (v.empty()) return std::nullopt;
  const Rgb rgb{v[0], v[1], v[2]};
  if (role == SpectrumRole::kEmission) return uplift_emission(rgb);
  if (role == SpectrumRole::kFactor) return uplift_factor(rgb);
  return uplift_reflectance(rgb);
}

MaybeSpectrum parse_table(const JsonValue& wavelengths, const JsonValue& json_values, NumberRange range) {
  const std::vector<double> lambda =
      wavelengths.numbers(1, kMaxSamples, {.min = 0, .max = 1e9, .min_open = true});
  const std::vector<double> y = json_values.numbers(1, kMaxSamples, range);
  if (lambda.empty() || y.empty()) return std::nullopt;
  const std::vector<Float> lambda_nm(lambda.begin(), lambda.end());
  for (std::size_t i = 1; i < lambda_nm.size(); ++i) {
    if (lambda_nm[i] > lambda_nm[i - 1]) continue;
    wavelengths.elements()[i].error(
        fmt::format("wavelengths must increase: {} nm follows {} nm", lambda[i], lambda[i - 1]));
    return std::nullopt;
  }
  if (lambda.size() != y.size()) {
    json_values.error(
        fmt::format("expected {} values, one for each wavelength, got {}", lambda.size(), y.size()));
    return std::nullopt;
  }
  return TabulatedSpectrum(lambda_nm, {y.begin(), y.end()});
}

MaybeSpectrum parse_file(const JsonValue& json, const JsonValue& column, NumberRange range) {
  const std::filesystem::path file = json.path();
  const auto number = static_cast<int>(column.integer(1, 1, 1000));
  if (file.empty()) return std::nullopt;
  try {
    TabulatedSpectrum table = read_spd(file, number);
    for (std::size_t i = 0; i < table.values().size(); ++i) {
      if (range.contains(table.values()[i])) continue;
      json.error(fmt::format("{}: the value {} at {} nm is not {}", file.string(), table.values()[i],
                             table.lambda_nm()[i], range.text()));
      return std::nullopt;
    }
    return table;
  } catch (const InputError& e) {
    json.error(e.diagnostics().front().text());
    return std::nullopt;
  }
}

MaybeSpectrum parse_illuminant(const JsonValue& json) {
  const std::string name = json.choice("", kIlluminantNames);
  return name.empty() ? MaybeSpectrum() : named_illuminant(name);
}

MaybeSpectrum parse_sellmeier(const JsonValue& json) {
  const std::vector<double> b = json.require("b").numbers(3, 3, {.min = -kLargest, .max = kLargest});
  const std::vector<double> c = json.require("c_um2").numbers(3, 3, {.min = -kLargest, .max = kLargest});
  json.reject_unknown_keys();
  if (b.empty() || c.empty()) return std::nullopt;
  SellmeierSpectrum s;
  for (std::size_t i = 0; i < 3; ++i) {
    s.b[i] = static_cast<Float>(b[i]);
    s.c_um2[i] = static_cast<Float>(c[i]);
  }
  return s;
}

MaybeSpectrum parse_cauchy(const JsonValue& json) {
  constexpr NumberRange kCoefficient{.min = -kLargest, .max = kLargest};
  CauchySpectrum s;
  s.a = static_cast<Float>(json.require("a").number(1, kCoefficient));
  s.b_um2 = static_cast<Float>(json.get("b_um2").number(0, kCoefficient));
  s.c_um4 = static_cast<Float>(json.get("c_um4").number(0, kCoefficient));
  json.reject_unknown_keys();
  return s;
}

/// A source's spectrum is no reflectance, and a refractive index is neither.
bool has_meaning(const JsonValue& json, std::string_view form, SpectrumRole role) {
  const bool is_source = form == "blackbody_K" || form == "illuminant";
  const bool is_index = form == "sellmeier" || form == "cauchy";
  if (is_source && role != SpectrumRole::kEmission) {
    json.error("is the spectrum of a light, which has no meaning here");
    return false;
  }
  if (is_index && role != SpectrumRole::kUnbounded) {
    json.error("is a refractive index, which has no meaning here");
    return false;
  }
  return true;
}

MaybeSpectrum parse_form(const JsonValue& json, std::string_view form, SpectrumRole role, double scale) {
  const JsonValue value = json.get(form);
  const NumberRange range = value_range(role, scale);
  if (!has_meaning(value, form, role)) return std::nullopt;
  if (form == "rgb") return parse_rgb(value, role, range);
  if (form == "wavelengths_nm") return parse_table(value, json.require("values"), range);
  if (form == "file") return parse_file(value, json.get("column"), range);
  if (form == "illuminant") return parse_illuminant(value);
  if (form == "sellmeier") return parse_sellmeier(value);
  if (form == "cauchy") return parse_cauchy(value);
  const double kelvin = value.number(0, {.min = 0, .max = 1e9, .min_open = true});
  if (kelvin == 0) return std::nullopt;
  return BlackbodySpectrum{static_cast<Float>(kelvin), 1};
}

/// One mistake, one message: a misspelt key says more than that none of the right ones is there.
void report_missing_form(const JsonValue& json) {
  const std::vector<std::string> keys = json.keys();
  if (json.get("values").exists()) {
    (void)json.require("wavelengths_nm");
  } else if (std::all_of(keys.begin(), keys.end(), [](const std::string& key) { return key == "scale"; })) {
    json.error(
        "expected one of \"rgb\", \"wavelengths_nm\" and \"values\", \"file\", \"blackbody_K\", "
        "\"illuminant\", "
        "\"sellmeier\", \"cauchy\"");
  }
  json.reject_unknown_keys();
}

MaybeSpectrum parse_object(const JsonValue& json, SpectrumRole role) {
  constexpr std::string_view kForms[] = {"rgb",        "wavelengths_nm", "file",  "blackbody_K",
                                         "illuminant", "sellmeier",      "cauchy"};
  const JsonValue json_scale = json.get("scale");
  const double scale = json_scale.number(1, {.min = 0, .max = kLargest});
  std::string_view form;
  for (const std::string_view f : kForms) {
    if (!json.get(f).exists()) continue;
    if (!form.empty()) {
      json.get(f).error(fmt::format("\"{}\" already gives the spectrum", form));
      return std::nullopt;
    }
    form = f;
  }
  if (form.empty()) {
    report_missing_form(json);
    return std::nullopt;
  }
  const MaybeSpectrum parsed = parse_form(json, form, role, scale);
  json.reject_unknown_keys();
  if (!parsed) return std::nullopt;
  return scale == 1 ? *parsed : parsed->scaled(static_cast<Float>(scale));
}

}  // namespace

Spectrum parse_spectrum(const JsonValue& json, SpectrumRole role, const Spectrum& fallback) {
  if (!json.exists()) return fallback;
  MaybeSpectrum parsed;
  if (json.is_number()) {
    const NumberRange range = value_range(role, 1);
    const double value = json.number(range.min - 1, range);
    if (range.contains(value)) parsed = Spectrum::constant(static_cast<Float>(value));
  } else if (json.is_object()) {
    parsed = parse_object(json, role);
  } else {
    json.error("expected a number or an object that gives a spectrum");
  }
  if (!parsed) return fallback;

  // "scale" comes on top of values that are each in range.
  const double largest = parsed->max_over(kCheckedRange);
  if (!std::isfinite(largest)) {
    json.error("reaches values beyond what a number can hold");
    return fallback;
  }
  if (role == SpectrumRole::kReflectance && largest > 1 + kReflectanceSlack) {
    json.error(fmt::format("a reflectance lies in [0, 1], this one reaches {:.6g}", largest));
    return fallback;
  }
  return *parsed;
}

}  // namespace spectrace
