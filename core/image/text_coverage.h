// SPDX-License-Identifier: Apache-2.0
// Lines of text as pixels.
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

namespace spectrace {

/// How much ink each pixel of a line of text has, in [0, 1]; the box holds the ink and nothing else.
struct TextCoverage {
  int width = 0, height = 0;
  int baseline = 0;  ///< row that letters stand on, from the top; below the box where all ink is higher
  std::vector<float> data;  ///< [height][width]
};

/// A font that distributions install (package fonts-dejavu-core on Debian); nothing where none is found.
std::optional<std::filesystem::path> find_caption_font();

/// One line of ASCII, other characters become '?'. Nothing where it cannot be drawn: no font, or OpenImageIO
/// built without FreeType. No text, no ink: a box of size 0.
[[nodiscard]] std::optional<TextCoverage> text_coverage(std::string_view text, int size_pixels,
                                                        const std::filesystem::path& font);

}  // namespace spectrace
