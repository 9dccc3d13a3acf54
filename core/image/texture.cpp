// SPDX-License-Identifier: Apache-2.0
#include "core/image/texture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/image/bilinear.h"
#include "core/image/spectral_image.h"
#include "core/spectra/rgb_uplift.h"

namespace spectrace {
namespace {

constexpr NumberRange kRepeatRange{.min = 0, .max = 1e6, .min_open = true};

bool is_odd(const Checkerboard& board, Vec2 uv) {
  const Float cells = std::floor(uv.x * board.repeat_u) + std::floor(uv.y * board.repeat_v);
  return cells - 2 * std::floor(cells / 2) != 0;
}

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
    return image_texture(read_image(file), file.string());
  } catch (const InputError& e) {
    json.error(e.diagnostics().front().text());
    return fallback;
  }
}

}  // namespace

BitmapTexture::BitmapTexture(const Image& rgb) : width_(rgb.width), height_(rgb.height) {
  SPECTRACE_CHECK(width_ > 0 && height_ > 0 && rgb.channels.size() == 3);
  std::vector<float> texels = rgb.data;
  for (float& x : texels) x = x > 0 ? std::min(x, 1.0f) : 0.0f;  // NaN becomes 0
  rgb_ = std::make_shared<const std::vector<float>>(std::move(texels));
}

Rgb BitmapTexture::rgb_at(Vec2 uv) const {
  const Bilinear texels(uv, width_, height_);
  Rgb rgb{};
  for (std::size_t c = 0; c < 3; ++c) {
    rgb[c] = texels.mean([&](std::size_t row, std::size_t column) {
      return double((*rgb_)[(row * static_cast<std::size_t>(width_) + column) * 3 + c]);
    });
  }
  return rgb;
}

SpectralTexture::SpectralTexture(SpectralImage image) {
  for (float& x : image.values()) x = x > 0 ? std::min(x, 1.0f) : 0.0f;  // NaN becomes 0
  image_ = std::make_shared<const SpectralImage>(std::move(image));
}

SampledSpectrum SpectralTexture::sample(const SampledWavelengths& lambda, Vec2 uv) const {
  const Bilinear texels(uv, image_->width(), image_->height());
  const auto width = static_cast<std::size_t>(image_->width());
  SampledSpectrum r;
  for (int i = 0; i < kLanes; ++i) {
    const SpectralImage::Place place = image_->place(lambda.lambda_nm(i));
    r[i] = static_cast<Float>(texels.mean([&](std::size_t row, std::size_t column) {
      return double(image_->at(row * width + column, place));
    }));
  }
  return r;
}

SampledSpectrum Texture::sample(const SampledWavelengths& lambda, Vec2 uv) const {
  if (const auto* spectrum = std::get_if<Spectrum>(&v_)) return spectrum->sample(lambda);
  if (const auto* board = std::get_if<Checkerboard>(&v_)) {
    return (is_odd(*board, uv) ? board->odd : board->even).sample(lambda);
  }
  if (const auto* spectra = std::get_if<SpectralTexture>(&v_)) return spectra->sample(lambda, uv);
  return uplift_reflectance_fast(std::get<BitmapTexture>(v_).rgb_at(uv)).sample(lambda);
}

Texture image_texture(const Image& image, const std::string& file) {
  if (std::optional<SpectralImage> spectra = spectral_channels(image, SpectralKind::kReflectance, file)) {
    return SpectralTexture(std::move(*spectra));
  }
  const std::array<std::string, 3> rgb{"R", "G", "B"};
  if (!image.find_channel("R") && has_spectral_channels(image, SpectralKind::kRadiance)) {
    throw InputError(file, "", "holds radiance (channels \"S0.\"), a texture needs reflectance (\"T.\")");
  }
  return BitmapTexture(image.select(rgb, file));
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
