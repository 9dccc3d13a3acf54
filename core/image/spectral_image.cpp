// SPDX-License-Identifier: Apache-2.0
#include "core/image/spectral_image.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <string_view>

#include "core/base/error.h"
#include "core/base/json.h"

namespace spectrace {

namespace {

// As of a scene's range: beyond it the unit or a digit is wrong.
constexpr NumberRange kWavelengths{.min = 100, .max = 10000};

/// "550,000000nm" in nanometres. The comma stands for the point, which separates layers in EXR.
std::optional<double> parse_wavelength(std::string_view text) {
  constexpr std::string_view kDigits = "0123456789,eE+-";
  const std::size_t unit_begin = std::min(text.find_first_not_of(kDigits), text.size());
  std::string digits(text.substr(0, unit_begin));
  std::replace(digits.begin(), digits.end(), ',', '.');
  const std::string_view unit = text.substr(unit_begin);
  const double to_nm = unit == "nm" ? 1 : unit == "um" ? 1e3 : unit == "mm" ? 1e6 : unit == "m" ? 1e9 : 0;
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (to_nm == 0 || error != std::errc() || end != digits.data() + digits.size()) return std::nullopt;
  return value * to_nm;
}

std::string_view prefix_of(SpectralKind kind) { return kind == SpectralKind::kReflectance ? "T." : "S0."; }

/// "T.R" would be a layer named T.
bool is_spectral(const std::string& channel, std::string_view prefix) {
  return channel.starts_with(prefix) && channel.size() > prefix.size() && channel[prefix.size()] >= '0' &&
         channel[prefix.size()] <= '9';
}

}  // namespace

SpectralImage::SpectralImage(int width, int height, std::vector<Float> lambda_nm, std::vector<float> values)
    : width_(width), height_(height), lambda_nm_(std::move(lambda_nm)), values_(std::move(values)) {
  SPECTRACE_CHECK(width_ > 0 && height_ > 0 && lambda_nm_.size() >= 2);
  SPECTRACE_CHECK(std::adjacent_find(lambda_nm_.begin(), lambda_nm_.end(), std::greater_equal<>()) ==
                  lambda_nm_.end());
  SPECTRACE_CHECK(values_.size() == std::size_t(width_) * std::size_t(height_) * lambda_nm_.size());
}

SpectralPlace spectral_place(std::span<const Float> lambda_nm, Float at_nm) {
  if (!(at_nm > lambda_nm.front())) return {0, 0};
  const auto above = std::lower_bound(lambda_nm.begin() + 1, lambda_nm.end() - 1, at_nm);
  const auto node = std::size_t(above - lambda_nm.begin()) - 1;
  return {node, std::min((at_nm - lambda_nm[node]) / (lambda_nm[node + 1] - lambda_nm[node]), Float(1))};
}

TabulatedSpectrum SpectralImage::spectrum(std::size_t texel) const {
  const auto begin = values_.begin() + std::ptrdiff_t(texel * lambda_nm_.size());
  return {lambda_nm_, {begin, begin + std::ptrdiff_t(lambda_nm_.size())}};
}

bool has_spectral_channels(std::span<const std::string> channels, SpectralKind kind) {
  return std::any_of(channels.begin(), channels.end(),
                     [&](const std::string& name) { return is_spectral(name, prefix_of(kind)); });
}

bool has_spectral_channels(const Image& image, SpectralKind kind) {
  return has_spectral_channels(image.channels, kind);
}

std::vector<SpectralChannel> find_spectral_channels(std::span<const std::string> channels, SpectralKind kind,
                                                    const std::string& file) {
  const std::string_view prefix = prefix_of(kind);
  std::vector<SpectralChannel> found;
  for (std::size_t i = 0; i < channels.size(); ++i) {
    const std::string& name = channels[i];
    if (!is_spectral(name, prefix)) continue;
    const std::optional<double> lambda_nm = parse_wavelength(std::string_view(name).substr(prefix.size()));
    if (!lambda_nm) {
      throw InputError(
          file, "",
          fmt::format("channel \"{}\": expected a wavelength behind \"{}\", with a decimal comma and a "
                      "unit: 550,000000nm",
                      name, prefix));
    }
    if (!kWavelengths.contains(*lambda_nm)) {
      throw InputError(file, "",
                       fmt::format("channel \"{}\": {} nm is not {}", name, *lambda_nm, kWavelengths.text()));
    }
    found.push_back({*lambda_nm, i, name});
  }
  std::sort(found.begin(), found.end(),
            [](const SpectralChannel& a, const SpectralChannel& b) { return a.lambda_nm < b.lambda_nm; });
  for (std::size_t i = 1; i < found.size(); ++i) {
    if (!(Float(found[i].lambda_nm) > Float(found[i - 1].lambda_nm))) {
      throw InputError(
          file, "",
          fmt::format("channels \"{}\" and \"{}\" are of one wavelength", found[i - 1].name, found[i].name));
    }
  }
  if (found.size() == 1) {
    throw InputError(file, "", fmt::format("\"{}\" is its only wavelength: no spectrum", found[0].name));
  }
  return found;
}

std::string spectral_channel_name(SpectralKind kind, double lambda_nm) {
  std::string digits = fmt::format("{:.6f}", lambda_nm);  // whatever the locale: with a point
  std::replace(digits.begin(), digits.end(), '.', ',');
  return fmt::format("{}{}nm", prefix_of(kind), digits);
}

std::optional<SpectralImage> spectral_channels(const Image& image, SpectralKind kind,
                                               const std::string& file) {
  const std::vector<SpectralChannel> found = find_spectral_channels(image.channels, kind, file);
  if (found.empty()) return std::nullopt;
  std::vector<Float> lambda_nm;
  for (const SpectralChannel& channel : found) lambda_nm.push_back(static_cast<Float>(channel.lambda_nm));
  const std::size_t pixels = std::size_t(image.width) * std::size_t(image.height);
  std::vector<float> values(pixels * found.size());
  for (std::size_t i = 0; i < pixels; ++i) {
    for (std::size_t c = 0; c < found.size(); ++c) {
      values[i * found.size() + c] = image.data[i * image.channels.size() + found[c].index];
    }
  }
  return SpectralImage(image.width, image.height, std::move(lambda_nm), std::move(values));
}

std::optional<std::string> check_emissive_units(const Metadata& metadata, const std::string& file) {
  const auto it = metadata.find("emissiveUnits");
  if (it == metadata.end()) {
    return fmt::format("{}: no attribute emissiveUnits; read as W.m^-2.sr^-1.nm^-1", file);
  }
  const auto* units = std::get_if<std::string>(&it->second);
  const std::string text = units == nullptr ? "a number" : *units;
  if (text != "W.m^-2.sr^-1" && text != "W.m^-2.sr^-1.nm^-1") {
    throw InputError(file, "attribute emissiveUnits",
                     fmt::format("expected W.m^-2.sr^-1 or W.m^-2.sr^-1.nm^-1, got {}", text));
  }
  return std::nullopt;
}

}  // namespace spectrace
