// SPDX-License-Identifier: Apache-2.0
// Images that are looked up over a footprint, kept tile by tile in one cache of limited size that all of them
// share: OpenImageIO's TextureSystem (ADR 0013).
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/image/footprint.h"
#include "core/image/image.h"
#include "core/image/texels.h"
#include "core/math/vec.h"

namespace spectrace {

inline constexpr std::size_t kTextureCacheMiB = 1024;  ///< until it is set
/// Of the whole process, from what is loaded next on: half for tiles, half for whole images. No lookup
/// changes.
void set_texture_cache_limit(std::size_t mebibytes);
/// What the tiles in the cache take.
[[nodiscard]] std::size_t texture_cache_bytes();

/// Some channels of an image over the plane; values clamped to [0, 1], NaN is 0; repeats with period 1; v = 0
/// at the bottom row. Immutable; copies share everything.
class CachedImage {
 public:
  /// All channels.
  explicit CachedImage(const Image& image);
  /// Throws InputError where the file cannot be read or lacks one of the channels.
  CachedImage(const std::filesystem::path& file, const std::vector<std::string>& channels,
              TexelCoding coding);

  /// Means over the footprint of channels [first, first + count). A footprint of no size gives the finest
  /// level, bilinear. Throws InputError where a file is damaged, or has changed, behind its header.
  void mean(Vec2 uv, const Footprint& over, std::size_t first, std::size_t count, float* means) const;
  [[nodiscard]] std::size_t channels() const;

 private:
  struct Entry;
  std::shared_ptr<const Entry> entry_;
};

}  // namespace spectrace
