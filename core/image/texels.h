// SPDX-License-Identifier: Apache-2.0
// What the texture cache reads from: the levels of an image, strip by strip or tile by tile. Internal to
// core/image.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/image/image.h"

namespace spectrace {

/// What the numbers of a file are: colours, whose integers are decoded from sRGB, or as stored.
enum class TexelCoding : std::uint8_t { kColour, kData };

struct TexelLevel {
  int width = 0, height = 0;
  int tile_width = 0, tile_height = 0;  ///< 0: is read by rows
};

/// Of one file, opened; for one thread at a time. What it gives lies in [0, 1]; NaN has become 0.
class TexelReader {
 public:
  virtual ~TexelReader() = default;
  /// Rows [y0, y1) of a level that is read by rows: [row][width][channel].
  [[nodiscard]] virtual std::vector<float> rows(std::size_t level, int y0, int y1) = 0;
  /// The tile whose upper left texel is (x, y); what lies beyond the image is 0.
  [[nodiscard]] virtual std::vector<float> tile(std::size_t level, int x, int y) = 0;
};

/// Immutable, shared between threads.
class TexelSource {
 public:
  virtual ~TexelSource() = default;
  /// From the finest on, each half as wide and high as the last, rounded down, to a single texel.
  [[nodiscard]] const std::vector<TexelLevel>& levels() const { return levels_; }
  [[nodiscard]] std::size_t channels() const { return channels_; }
  /// Throws InputError.
  [[nodiscard]] virtual std::unique_ptr<TexelReader> open() const = 0;

 protected:
  std::vector<TexelLevel> levels_;
  std::size_t channels_ = 0;
};

/// The levels of an image that has none of its own.
[[nodiscard]] std::vector<TexelLevel> halved_levels(int width, int height);

[[nodiscard]] std::unique_ptr<TexelSource> texels_in_memory(const Image& image);

/// The names of the channels of a file, as read_image() gives them, from its header. Throws InputError.
[[nodiscard]] std::vector<std::string> texel_channels(const std::filesystem::path& file);
/// Some channels of a file, in that order. A file without levels of its own is read once: what is damaged
/// throws InputError here. It is kept whole in memory if it fits (kept_levels.h), else its levels of at most
/// kKeptTexels numbers, and the finer ones are made again from the file, strip by strip, each time they are
/// asked for. The numbers are the same.
[[nodiscard]] std::unique_ptr<TexelSource> texels_of_file(const std::filesystem::path& file,
                                                          const std::vector<std::string>& channels,
                                                          TexelCoding coding);
/// 1 MiB of floats: 300 x 300 of RGB.
inline constexpr std::size_t kKeptTexels = std::size_t(1) << 18;

}  // namespace spectrace
