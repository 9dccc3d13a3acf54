// SPDX-License-Identifier: Apache-2.0
// What charts are drawn on: SVG, or pixels.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "core/image/drawing.h"

namespace spectrace::cli {

struct Stroke {
  std::string_view colour;  ///< "#rrggbb"
  double width = 1;         ///< pixels
  int dash = 0;             ///< pixels drawn between gaps; 0: no gaps
};

/// Pixels from the upper left corner.
class Canvas {
 public:
  virtual ~Canvas() = default;
  virtual void polyline(std::span<const Place> places, const Stroke& stroke) = 0;
  /// `label`: told where the pointer rests, if it can be.
  virtual void disk(Place center, double radius, std::string_view colour, const std::string& label) = 0;
  virtual void box(Place corner, double width, double height, std::string_view colour,
                   const std::string& label) = 0;
  /// Turned clockwise about `at`.
  virtual void text(Place at, const std::string& text, TextAnchor anchor = TextAnchor::kStart,
                    double turn_deg = 0, double size = 11) = 0;
};

class SvgCanvas final : public Canvas {
 public:
  SvgCanvas(double width, double height);
  void polyline(std::span<const Place> places, const Stroke& stroke) override;
  void disk(Place center, double radius, std::string_view colour, const std::string& label) override;
  void box(Place corner, double width, double height, std::string_view colour,
           const std::string& label) override;
  void text(Place at, const std::string& text, TextAnchor anchor, double turn_deg, double size) override;

  /// Stands alone as a file and inside HTML.
  [[nodiscard]] std::string document() const { return text_ + "</svg>\n"; }

 private:
  std::string text_;
};

class PixelCanvas final : public Canvas {
 public:
  PixelCanvas(double width, double height);
  void polyline(std::span<const Place> places, const Stroke& stroke) override;
  void disk(Place center, double radius, std::string_view colour, const std::string& label) override;
  void box(Place corner, double width, double height, std::string_view colour,
           const std::string& label) override;
  void text(Place at, const std::string& text, TextAnchor anchor, double turn_deg, double size) override;

  /// Twice as many pixels each way. Text is left out where there is no font.
  [[nodiscard]] Image image() const { return drawing_.image(); }

 private:
  Drawing drawing_;
};

/// Text as HTML and SVG hold it: &, <, > and " escaped.
std::string escaped(const std::string& text);

}  // namespace spectrace::cli
