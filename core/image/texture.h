// SPDX-License-Identifier: Apache-2.0
// A reflectance over a surface: one spectrum, a checkerboard of two, or an RGB image uplifted per lookup.
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

class Texture {
 public:
  Texture() : v_(Spectrum::constant(0)) {}
  Texture(Spectrum s) : v_(std::move(s)) {}  // NOLINT(google-explicit-constructor): a spectrum is a texture
  Texture(Checkerboard c) : v_(std::move(c)) {}   // NOLINT(google-explicit-constructor)
  Texture(BitmapTexture b) : v_(std::move(b)) {}  // NOLINT(google-explicit-constructor)

  [[nodiscard]] SampledSpectrum sample(const SampledWavelengths& lambda, Vec2 uv) const;
  [[nodiscard]] bool is_textured() const { return !std::holds_alternative<Spectrum>(v_); }

 private:
  std::variant<Spectrum, Checkerboard, BitmapTexture> v_;
};

/// A spectrum (parse_spectrum, kReflectance), {"checkerboard": {"even": .., "odd": .., "repeat": [u, v]}} or
/// {"bitmap": "file.png"}. Problems are recorded in the document.
Texture parse_texture(const JsonValue& json, const Spectrum& fallback = {});

}  // namespace spectrace
