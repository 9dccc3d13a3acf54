// SPDX-License-Identifier: Apache-2.0
// A reflectance over a surface: one spectrum, a checkerboard of two, an RGB image uplifted per
// lookup, or an image of spectra.
#pragma once

#include <filesystem>
#include <memory>
#include <variant>

#include "core/base/json.h"
#include "core/image/image.h"
#include "core/math/vec.h"
#include "core/spectra/spectrum.h"

namespace spectrace {

/// `even` where floor(u · repeat_u) + floor(v · repeat_v) is even, else `odd`.
struct Checkerboard {
  Spectrum even, odd;
  Float repeat_u = 1, repeat_v = 1;
};

/// Texels kept as sigmoid coefficients' source RGB; bilinear, repeating; v = 0 at the bottom row.
class BitmapTexture {
 public:
  /// Linear RGB image; values clamped to [0, 1].
  explicit BitmapTexture(const Image& rgb);
  [[nodiscard]] Rgb rgb_at(Vec2 uv) const;

 private:
  int width_ = 0, height_ = 0;
  std::shared_ptr<const std::vector<float>> rgb_;
};

class SpectralImage;

/// A spectrum a texel, read at a path's wavelengths; bilinear, repeating; v = 0 at the bottom row.
class SpectralTexture {
 public:
  /// Values clamped to [0, 1]; NaN becomes 0.
  explicit SpectralTexture(SpectralImage image);
  [[nodiscard]] SampledSpectrum sample(const SampledWavelengths& lambda, Vec2 uv) const;

 private:
  std::shared_ptr<const SpectralImage> image_;
};

class Texture {
 public:
  Texture() : v_(Spectrum::constant(0)) {}
  Texture(Spectrum s) : v_(std::move(s)) {}  // NOLINT(google-explicit-constructor): a spectrum is a texture
  Texture(Checkerboard c) : v_(std::move(c)) {}     // NOLINT(google-explicit-constructor)
  Texture(BitmapTexture b) : v_(std::move(b)) {}    // NOLINT(google-explicit-constructor)
  Texture(SpectralTexture s) : v_(std::move(s)) {}  // NOLINT(google-explicit-constructor)

  [[nodiscard]] SampledSpectrum sample(const SampledWavelengths& lambda, Vec2 uv) const;
  [[nodiscard]] bool is_textured() const { return !std::holds_alternative<Spectrum>(v_); }

 private:
  std::variant<Spectrum, Checkerboard, BitmapTexture, SpectralTexture> v_;
};

/// An image's spectra of reflectance (channels "T.550,000000nm", ...) where it has them, else its R, G, B.
/// Throws InputError naming `file` where it has neither.
Texture image_texture(const Image& image, const std::string& file);

/// A spectrum (parse_spectrum, kReflectance), {"checkerboard": {"even": .., "odd": .., "repeat": [u, v]}} or
/// {"bitmap": "file.png"}. Problems are recorded in the document.
Texture parse_texture(const JsonValue& json, const Spectrum& fallback = {});

}  // namespace spectrace
