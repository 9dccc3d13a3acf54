// SPDX-License-Identifier: Apache-2.0
#include "core/image/texture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/image/spectral_image.h"
#include "core/spectra/cie_tables.h"
#include "core/spectra/rgb_uplift.h"

namespace spectrace {
namespace {

constexpr Float kMeanStepNm = 5;  // of a mean's spectrum: as fine as illuminants are tabulated
constexpr NumberRange kRepeatRange{.min = 0, .max = 1e6, .min_open = true};

Texture parse_checkerboard(const JsonValue& json) {
  Checkerboard board;
  board.even = parse_spectrum(json.require("even"), SpectrumRole::kReflectance);
  board.odd = parse_spectrum(json.require("odd"), SpectrumRole::kReflectance);
  if (const std::vector<double> repeat = json.get("repeat").numbers(2, 2, kRepeatRange); !repeat.empty()) {
    board.repeat_u = static_cast<Float>(repeat[0]);
    board.repeat_v = static_cast<Float>(repeat[1]);
  }
  json.reject_unknown_keys();
  return board;
}

Texture parse_bitmap(const JsonValue& json, const Spectrum& fallback) {
  const std::filesystem::path file = json.path();
  if (file.empty()) return fallback;
  try {
    return image_texture(file);
  } catch (const InputError& e) {
    json.error(e.diagnostics().front().text());
    return fallback;
  }
}

}  // namespace

BitmapTexture::BitmapTexture(CachedImage rgb) : rgb_(std::move(rgb)) {
  SPECTRACE_CHECK(rgb_.channels() == 3);
}

Rgb BitmapTexture::rgb_at(Vec2 uv, const Footprint& over) const {
  std::array<float, 3> rgb{};
  rgb_.mean(uv, over, 0, 3, rgb.data());
  return {double(rgb[0]), double(rgb[1]), double(rgb[2])};
}

SpectralTexture::SpectralTexture(CachedImage image, std::vector<Float> lambda_nm)
    : image_(std::move(image)), lambda_nm_(std::make_shared<const std::vector<Float>>(std::move(lambda_nm))) {
  SPECTRACE_CHECK(lambda_nm_->size() >= 2 && lambda_nm_->size() == image_.channels());
}

SampledSpectrum SpectralTexture::sample(const SampledWavelengths& lambda, Vec2 uv,
                                        const Footprint& over) const {
  std::array<SpectralPlace, kLanes> places;
  std::size_t first = lambda_nm_->size(), last = 0;  // of the channels that take part
  for (int i = 0; i < kLanes; ++i) {
    const SpectralPlace place = spectral_place(*lambda_nm_, lambda.lambda_nm(i));
    places[std::size_t(i)] = place;
    first = std::min(first, place.node);
    last = std::max(last, place.node + 2);
  }
  SampledSpectrum r;
  const auto take = [&](int lane, const float* values) {
    const Float below = values[0], above = values[1];
    r[lane] = below + places[std::size_t(lane)].weight * (above - below);
  };
  // The cache filters four channels at a time: as much work as two for each lane apart.
  constexpr std::size_t kAtOnce = 4 * std::size_t(kLanes);
  if (last - first <= kAtOnce) {
    std::array<float, kAtOnce> values{};
    image_.mean(uv, over, first, last - first, values.data());
    for (int i = 0; i < kLanes; ++i) take(i, &values[places[std::size_t(i)].node - first]);
  } else {
    for (int i = 0; i < kLanes; ++i) {
      std::array<float, 2> values{};
      image_.mean(uv, over, places[std::size_t(i)].node, 2, values.data());
      take(i, values.data());
    }
  }
  return r;
}

SampledSpectrum Texture::sample(const SampledWavelengths& lambda, Vec2 uv, const Footprint& over) const {
  if (const auto* spectrum = std::get_if<Spectrum>(&v_)) return spectrum->sample(lambda);
  if (const auto* board = std::get_if<Checkerboard>(&v_)) {
    return (board->is_odd(uv) ? board->odd : board->even).sample(lambda);
  }
  if (const auto* spectra = std::get_if<SpectralTexture>(&v_)) return spectra->sample(lambda, uv, over);
  return uplift_reflectance_fast(std::get<BitmapTexture>(v_).rgb_at(uv, over)).sample(lambda);
}

Spectrum Texture::mean() const {
  if (const auto* spectrum = std::get_if<Spectrum>(&v_)) return *spectrum;
  constexpr std::array<Float, kLanes> kEven = [] {
    std::array<Float, kLanes> pdf{};
    pdf.fill(1);
    return pdf;
  }();
  std::vector<Float> lambda_nm, values;
  for (Float first = kCieMinNm; first <= kCieMaxNm; first += kMeanStepNm * kLanes) {
    std::array<Float, kLanes> nm{};
    for (std::size_t i = 0; i < kLanes; ++i) nm[i] = first + kMeanStepNm * Float(i);
    const SampledWavelengths lambda(nm, kEven);
    SampledSpectrum mean;
    if (const auto* board = std::get_if<Checkerboard>(&v_)) {
      mean = (board->even.sample(lambda) + board->odd.sample(lambda)) * Float(0.5);
    } else {
      mean = sample(lambda, {Float(0.5), Float(0.5)}, kWholeFootprint);
    }
    for (int i = 0; i < kLanes; ++i) {
      lambda_nm.push_back(nm[std::size_t(i)]);
      values.push_back(mean[i]);
    }
  }
  return TabulatedSpectrum(std::move(lambda_nm), std::move(values));
}

Texture image_texture(const std::filesystem::path& file) {
  const std::vector<std::string> names = texel_channels(file);
  if (const auto spectra = find_spectral_channels(names, SpectralKind::kReflectance, file.string());
      !spectra.empty()) {
    std::vector<std::string> channels;
    std::vector<Float> lambda_nm;
    for (const SpectralChannel& channel : spectra) {
      channels.push_back(channel.name);
      lambda_nm.push_back(Float(channel.lambda_nm));
    }
    return SpectralTexture(CachedImage(file, channels, TexelCoding::kColour), std::move(lambda_nm));
  }
  const bool is_rgb = std::find(names.begin(), names.end(), "R") != names.end();
  if (!is_rgb && has_spectral_channels(names, SpectralKind::kRadiance)) {
    throw InputError(file.string(), "",
                     "holds radiance (channels \"S0.\"), a texture needs reflectance (\"T.\")");
  }
  return BitmapTexture(CachedImage(file, {"R", "G", "B"}, TexelCoding::kColour));
}

Texture parse_texture(const JsonValue& json, const Spectrum& fallback) {
  if (!json.is_object()) return parse_spectrum(json, SpectrumRole::kReflectance, fallback);
  const JsonValue board = json.get("checkerboard"), bitmap = json.get("bitmap");
  if (!board.exists() && !bitmap.exists()) return parse_spectrum(json, SpectrumRole::kReflectance, fallback);
  json.reject_unknown_keys();
  if (board.exists() && bitmap.exists()) bitmap.error("\"checkerboard\" already gives the texture");
  return board.exists() ? parse_checkerboard(board) : parse_bitmap(bitmap, fallback);
}

}  // namespace spectrace
