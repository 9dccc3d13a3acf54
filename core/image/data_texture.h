// SPDX-License-Identifier: Apache-2.0
// Numbers over a surface that are no colours: opacities, weights, normals. Pixels are taken as stored,
// neither decoded from sRGB nor uplifted to spectra.
#pragma once

#include <filesystem>
#include <memory>
#include <variant>
#include <vector>

#include "core/base/json.h"
#include "core/image/image.h"
#include "core/math/vec.h"

namespace spectrace {

/// Some channels of an image; bilinear, repeating; v = 0 at the bottom row.
class DataBitmap {
 public:
  /// Values clamped to [0, 1]; NaN becomes 0.
  explicit DataBitmap(const Image& image);
  [[nodiscard]] Float at(Vec2 uv, std::size_t channel) const;

 private:
  int width_ = 0, height_ = 0;
  std::size_t channels_ = 0;
  std::shared_ptr<const std::vector<float>> texels_;
};

/// `even` where floor(u · repeat_u) + floor(v · repeat_v) is even, else `odd`.
struct ScalarCheckerboard {
  Float even = 1, odd = 0;
  Vec2 repeat{1, 1};
};

/// A number in [0, 1] over a surface.
class ScalarTexture {
 public:
  ScalarTexture() = default;
  ScalarTexture(Float constant) : v_(constant) {}         // NOLINT(google-explicit-constructor)
  ScalarTexture(ScalarCheckerboard board) : v_(board) {}  // NOLINT(google-explicit-constructor)
  /// Its first channel.
  explicit ScalarTexture(DataBitmap bitmap) : v_(std::move(bitmap)) {}

  [[nodiscard]] Float at(Vec2 uv) const;
  [[nodiscard]] bool is_textured() const { return !std::holds_alternative<Float>(v_); }

 private:
  std::variant<Float, ScalarCheckerboard, DataBitmap> v_{Float(1)};
};

/// Unit normals in the frame of the texture: x along u, y along v, z outwards.
class NormalTexture {
 public:
  NormalTexture() : NormalTexture(flat()) {}
  /// R, G, B: (x, y, z + 1) / 2, the usual encoding.
  explicit NormalTexture(DataBitmap bitmap) : bitmap_(std::move(bitmap)) {}
  /// z > 0: a texel that points inwards, or nowhere, is flat.
  [[nodiscard]] Vec3 at(Vec2 uv) const;

 private:
  static DataBitmap flat();
  DataBitmap bitmap_;
};

/// A number, {"checkerboard": {"even": .., "odd": .., "repeat": [u, v]}} or {"bitmap": "file.png"}, of which
/// the alpha channel is taken where it has one, else the first. Problems are recorded in the document.
ScalarTexture parse_scalar_texture(const JsonValue& json);
/// A file name.
NormalTexture parse_normal_texture(const JsonValue& json);

}  // namespace spectrace
