// SPDX-License-Identifier: Apache-2.0
// Numbers over a surface that are no colours: opacities, weights, normals. Pixels are taken as stored,
// neither decoded from sRGB nor uplifted to spectra.
#pragma once

#include <filesystem>
#include <optional>
#include <variant>

#include "core/base/json.h"
#include "core/image/texture_cache.h"
#include "core/math/vec.h"

namespace spectrace {

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
  explicit ScalarTexture(CachedImage bitmap) : v_(std::move(bitmap)) {}

  /// Images are averaged over the footprint; checkerboards are not.
  [[nodiscard]] Float at(Vec2 uv, const Footprint& over = kPointFootprint) const;
  /// Over all of the surface: checkerboards half and half.
  [[nodiscard]] Float mean() const;
  [[nodiscard]] bool is_textured() const { return !std::holds_alternative<Float>(v_); }
  /// Its lookups have footprints.
  [[nodiscard]] bool is_image() const { return std::holds_alternative<CachedImage>(v_); }

 private:
  std::variant<Float, ScalarCheckerboard, CachedImage> v_{Float(1)};
};

/// Unit normals in the frame of the texture: x along u, y along v, z outwards.
class NormalTexture {
 public:
  NormalTexture() = default;  // flat
  /// R, G, B: (x, y, z + 1) / 2, the usual encoding.
  explicit NormalTexture(CachedImage bitmap);
  /// z > 0: where the mean over the footprint points inwards, or nowhere, it is flat.
  [[nodiscard]] Vec3 at(Vec2 uv, const Footprint& over = kPointFootprint) const;
  [[nodiscard]] bool is_textured() const { return is_image(); }
  [[nodiscard]] bool is_image() const { return bitmap_.has_value(); }

 private:
  std::optional<CachedImage> bitmap_;
};

/// Of a file, its alpha channel where it has one, else its first. Throws InputError.
ScalarTexture scalar_bitmap(const std::filesystem::path& file);
/// Of a file, its R, G, B. Throws InputError.
NormalTexture normal_bitmap(const std::filesystem::path& file);

/// A number, {"checkerboard": {"even": .., "odd": .., "repeat": [u, v]}} or {"bitmap": "file.png"}, of which
/// the alpha channel is taken where it has one, else the first. Problems are recorded in the document.
ScalarTexture parse_scalar_texture(const JsonValue& json);
/// A file name.
NormalTexture parse_normal_texture(const JsonValue& json);

}  // namespace spectrace
