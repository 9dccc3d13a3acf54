// SPDX-License-Identifier: Apache-2.0
// A reflectance over a surface: one spectrum, a checkerboard of two, an RGB image uplifted per
// lookup, or an image of spectra.
#pragma once

#include <cmath>
#include <filesystem>
#include <memory>
#include <variant>
#include <vector>

#include "core/base/json.h"
#include "core/image/image.h"
#include "core/image/texture_cache.h"
#include "core/math/vec.h"
#include "core/spectra/spectrum.h"

namespace spectrace {

/// `even` where floor(u · repeat_u) + floor(v · repeat_v) is even, else `odd`.
struct Checkerboard {
  Spectrum even, odd;
  Float repeat_u = 1, repeat_v = 1;

  [[nodiscard]] bool is_odd(Vec2 uv) const {
    const Float cells = std::floor(uv.x * repeat_u) + std::floor(uv.y * repeat_v);
    return cells - 2 * std::floor(cells / 2) != 0;
  }
};

/// Linear RGB, uplifted after it has been filtered; repeating; v = 0 at the bottom row.
class BitmapTexture {
 public:
  /// R, G, B; values clamped to [0, 1]; NaN becomes 0.
  explicit BitmapTexture(CachedImage rgb);
  explicit BitmapTexture(const Image& rgb) : BitmapTexture(CachedImage(rgb)) {}
  [[nodiscard]] Rgb rgb_at(Vec2 uv, const Footprint& over = kPointFootprint) const;

 private:
  CachedImage rgb_;
};

/// A spectrum a texel, read at a path's wavelengths; repeating; v = 0 at the bottom row.
class SpectralTexture {
 public:
  /// `lambda_nm`: of each channel, strictly increasing, at least two. Values clamped to [0, 1]; NaN becomes
  /// 0.
  SpectralTexture(CachedImage image, std::vector<Float> lambda_nm);
  [[nodiscard]] SampledSpectrum sample(const SampledWavelengths& lambda, Vec2 uv,
                                       const Footprint& over = kPointFootprint) const;

 private:
  CachedImage image_;
  std::shared_ptr<const std::vector<Float>> lambda_nm_;
};

class Texture {
 public:
  Texture() : v_(Spectrum::constant(0)) {}
  Texture(Spectrum s) : v_(std::move(s)) {}  // NOLINT(google-explicit-constructor): a spectrum is a texture
  Texture(Checkerboard c) : v_(std::move(c)) {}     // NOLINT(google-explicit-constructor)
  Texture(BitmapTexture b) : v_(std::move(b)) {}    // NOLINT(google-explicit-constructor)
  Texture(SpectralTexture s) : v_(std::move(s)) {}  // NOLINT(google-explicit-constructor)

  /// Images are averaged over the footprint; checkerboards are not.
  [[nodiscard]] SampledSpectrum sample(const SampledWavelengths& lambda, Vec2 uv,
                                       const Footprint& over = kPointFootprint) const;
  /// One spectrum for all of the surface, at every 5 nm: checkerboards half and half, images over all of
  /// them.
  [[nodiscard]] Spectrum mean() const;
  [[nodiscard]] bool is_textured() const { return !std::holds_alternative<Spectrum>(v_); }
  /// How many spectra the surface shows, if they can be counted; 0: an image. palette_index() is which of
  /// them is at uv, palette_uv() a place that shows it.
  [[nodiscard]] std::size_t palette_size() const {
    if (is_image()) return 0;
    return is_textured() ? 2 : 1;
  }
  [[nodiscard]] std::size_t palette_index(Vec2 uv) const {
    const auto* board = std::get_if<Checkerboard>(&v_);
    return board != nullptr && board->is_odd(uv) ? 1 : 0;
  }
  [[nodiscard]] Vec2 palette_uv(std::size_t index) const {
    const auto* board = std::get_if<Checkerboard>(&v_);
    if (board == nullptr) return {};
    return {(Float(index) + Float(0.5)) / board->repeat_u, Float(0.5) / board->repeat_v};
  }
  /// Its lookups have footprints.
  [[nodiscard]] bool is_image() const {
    return std::holds_alternative<BitmapTexture>(v_) || std::holds_alternative<SpectralTexture>(v_);
  }

 private:
  std::variant<Spectrum, Checkerboard, BitmapTexture, SpectralTexture> v_;
};

/// A file's spectra of reflectance (channels "T.550,000000nm", ...) where it has them, else its R, G, B.
/// Throws InputError where it has neither or cannot be read.
Texture image_texture(const std::filesystem::path& file);

/// A spectrum (parse_spectrum, kReflectance), {"checkerboard": {"even": .., "odd": .., "repeat": [u, v]}} or
/// {"bitmap": "file.png"}. Problems are recorded in the document.
Texture parse_texture(const JsonValue& json, const Spectrum& fallback = {});

}  // namespace spectrace
