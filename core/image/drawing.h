// SPDX-License-Identifier: Apache-2.0
// Lines, disks, boxes and text on pixels, with smooth edges.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <span>
#include <string_view>

#include "core/image/image.h"
#include "core/image/text_coverage.h"

namespace spectrace {

/// [pixels] from the left and from the top.
struct Place {
  double x = 0, y = 0;
};
/// R, G, B as screens hold them (sRGB), in [0, 1].
using InkColour = std::array<float, 3>;

enum class TextAnchor : std::uint8_t { kStart, kMiddle, kEnd };

/// A white sheet. What lies outside is cut off.
class Drawing {
 public:
  /// All places, sizes and widths are multiplied by `scale`. Without a font, text is left out.
  Drawing(double width, double height, double scale,
          const std::optional<std::filesystem::path>& font = find_caption_font());

  void segment(Place from, Place to, double stroke_width, const InkColour& colour);
  void disk(Place center, double radius, const InkColour& colour);
  /// Sides along the axes; `corner`: the upper left one.
  void box(Place corner, double width, double height, const InkColour& colour);
  /// Its baseline goes through `at`, turned clockwise about it.
  void text(Place at, std::string_view text, double size, TextAnchor anchor, double turn_deg);

  /// R, G, B, linear.
  [[nodiscard]] Image image() const;

 private:
  /// Covers pixels from `low` to `high` (in pixels of the image), each by `coverage(x, y)` of its centre.
  template <typename Coverage>
  void fill(Place low, Place high, const InkColour& colour, const Coverage& coverage);

  double scale_;
  std::optional<std::filesystem::path> font_;
  Image encoded_;  // sRGB
};

}  // namespace spectrace
