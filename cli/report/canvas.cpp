// SPDX-License-Identifier: Apache-2.0
#include "cli/report/canvas.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace spectrace::cli {

namespace {

constexpr double kPixelScale = 2;
constexpr double kGap = 3;  // pixels, of dashed lines

const char* svg_name(TextAnchor anchor) {
  switch (anchor) {
    case TextAnchor::kMiddle:
      return "middle";
    case TextAnchor::kEnd:
      return "end";
    case TextAnchor::kStart:
      break;
  }
  return "start";
}

InkColour ink_of(std::string_view colour) {
  InkColour ink{};
  for (std::size_t c = 0; c < 3; ++c) {
    int value = 0;
    const char* digits = colour.data() + 1 + 2 * c;
    std::from_chars(digits, digits + 2, value, 16);
    ink[c] = float(value) / 255;
  }
  return ink;
}

}  // namespace

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

SvgCanvas::SvgCanvas(double width, double height)
    : text_(fmt::format(
          "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:.0f} {1:.0f}\" width=\"{0:.0f}\" "
          "height=\"{1:.0f}\" font-family=\"sans-serif\" font-size=\"11\">\n"
          "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n",
          width, height)) {}

void SvgCanvas::polyline(std::span<const Place> places, const Stroke& stroke) {
  std::string path;
  for (const Place& p : places) path += fmt::format("{}{:.1f},{:.1f}", path.empty() ? "" : " ", p.x, p.y);
  const std::string dash =
      stroke.dash == 0 ? "" : fmt::format(" stroke-dasharray=\"{} {}\"", stroke.dash, kGap);
  text_ += fmt::format("<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{}\"{}/>\n", path,
                       stroke.colour, stroke.width, dash);
}

void SvgCanvas::disk(Place center, double radius, std::string_view colour, const std::string& label) {
  text_ += fmt::format(
      "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\" fill=\"{}\" "
      "data-label=\"{}\"><title>{}</title></circle>\n",
      center.x, center.y, radius, colour, escaped(label), escaped(label));
}

void SvgCanvas::box(Place corner, double width, double height, std::string_view colour,
                    const std::string& label) {
  const std::string told = label.empty() ? "" : fmt::format(" data-label=\"{}\"", escaped(label));
  text_ += fmt::format(
      "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{}\" height=\"{:.1f}\" fill=\"{}\"{}>"
      "<title>{}</title></rect>\n",
      corner.x, corner.y, width, height, colour, told, escaped(label));
}

void SvgCanvas::text(Place at, const std::string& text, TextAnchor anchor, double turn_deg, double size) {
  const std::string turn =
      turn_deg == 0 ? "" : fmt::format(" transform=\"rotate({} {:.1f} {:.1f})\"", turn_deg, at.x, at.y);
  text_ += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" font-size=\"{}\" text-anchor=\"{}\"{}>{}</text>\n",
                       at.x, at.y, size, svg_name(anchor), turn, escaped(text));
}

PixelCanvas::PixelCanvas(double width, double height) : drawing_(width, height, kPixelScale) {}

void PixelCanvas::polyline(std::span<const Place> places, const Stroke& stroke) {
  const InkColour ink = ink_of(stroke.colour);
  const double period = stroke.dash + kGap;
  double along = 0;  // of the dashes, over all segments
  for (std::size_t i = 1; i < places.size(); ++i) {
    const Place a = places[i - 1], b = places[i];
    const double length = std::hypot(b.x - a.x, b.y - a.y);
    const auto between = [&](double s) -> Place {
      return {a.x + (b.x - a.x) * s / length, a.y + (b.y - a.y) * s / length};
    };
    if (stroke.dash == 0 || length == 0) {
      drawing_.segment(a, b, stroke.width, ink);
      continue;
    }
    for (double s = -std::fmod(along, period); s < length; s += period) {
      const double from = std::max(s, 0.0), to = std::min(s + stroke.dash, length);
      if (from < to) drawing_.segment(between(from), between(to), stroke.width, ink);
    }
    along += length;
  }
}

void PixelCanvas::disk(Place center, double radius, std::string_view colour, const std::string&) {
  drawing_.disk(center, radius, ink_of(colour));
}

void PixelCanvas::box(Place corner, double width, double height, std::string_view colour,
                      const std::string&) {
  drawing_.box(corner, width, height, ink_of(colour));
}

void PixelCanvas::text(Place at, const std::string& text, TextAnchor anchor, double turn_deg, double size) {
  drawing_.text(at, text, size, anchor, turn_deg);
}

}  // namespace spectrace::cli
