// SPDX-License-Identifier: Apache-2.0
#include "core/image/drawing.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/math/math.h"
#include "core/spectra/color.h"

namespace spectrace {

namespace {

constexpr InkColour kInk{0.13F, 0.13F, 0.13F};

/// Of a shape whose edge lies `inside` pixels from the pixel's centre: as if the edge were straight.
float edge_coverage(double inside) { return float(std::clamp(inside + 0.5, 0.0, 1.0)); }

}  // namespace

Drawing::Drawing(double width, double height, double scale, const std::optional<std::filesystem::path>& font)
    : scale_(scale),
      font_(font),
      encoded_(int(std::ceil(width * scale)), int(std::ceil(height * scale)), {"R", "G", "B"}) {
  SPECTRACE_CHECK(width > 0 && height > 0 && scale > 0);
  std::fill(encoded_.data.begin(), encoded_.data.end(), 1.0F);
}

template <typename Coverage>
void Drawing::fill(Place low, Place high, const InkColour& colour, const Coverage& coverage) {
  const auto first = [](double at) { return std::max(0, int(std::floor(at)) - 1); };
  const auto end = [](double at, int size) { return std::min(size, int(std::ceil(at)) + 2); };
  for (int y = first(low.y); y < end(high.y, encoded_.height); ++y) {
    for (int x = first(low.x); x < end(high.x, encoded_.width); ++x) {
      const float covered = coverage(x + 0.5, y + 0.5);
      if (covered <= 0) continue;
      for (std::size_t c = 0; c < 3; ++c) {
        float& pixel = encoded_.at(x, y, c);
        pixel += covered * (colour[c] - pixel);
      }
    }
  }
}

void Drawing::segment(Place from, Place to, double stroke_width, const InkColour& colour) {
  const double ax = from.x * scale_, ay = from.y * scale_, dx = to.x * scale_ - ax, dy = to.y * scale_ - ay;
  const double half = stroke_width * scale_ / 2, squared = dx * dx + dy * dy;
  const Place low{std::min(ax, ax + dx) - half, std::min(ay, ay + dy) - half};
  const Place high{std::max(ax, ax + dx) + half, std::max(ay, ay + dy) + half};
  fill(low, high, colour, [&](double x, double y) {
    const double along = squared > 0 ? std::clamp(((x - ax) * dx + (y - ay) * dy) / squared, 0.0, 1.0) : 0;
    return edge_coverage(half - std::hypot(x - ax - along * dx, y - ay - along * dy));
  });
}

void Drawing::disk(Place center, double radius, const InkColour& colour) {
  const double cx = center.x * scale_, cy = center.y * scale_, r = radius * scale_;
  fill({cx - r, cy - r}, {cx + r, cy + r}, colour,
       [&](double x, double y) { return edge_coverage(r - std::hypot(x - cx, y - cy)); });
}

void Drawing::box(Place corner, double width, double height, const InkColour& colour) {
  const double x0 = corner.x * scale_, y0 = corner.y * scale_;
  const double x1 = x0 + width * scale_, y1 = y0 + height * scale_;
  const auto share = [](double at, double low, double high) {
    return std::clamp(std::min(high, at + 0.5) - std::max(low, at - 0.5), 0.0, 1.0);
  };
  fill({x0, y0}, {x1, y1}, colour,
       [&](double x, double y) { return float(share(x, x0, x1) * share(y, y0, y1)); });
}

void Drawing::text(Place at, std::string_view text, double size, TextAnchor anchor, double turn_deg) {
  if (!font_) return;
  const auto ink = text_coverage(text, std::max(1, int(std::lround(size * scale_))), *font_);
  if (!ink || ink->data.empty()) return;
  const double width = ink->width, height = ink->height;
  const double start = anchor == TextAnchor::kEnd ? width : anchor == TextAnchor::kMiddle ? width / 2 : 0;
  const double ax = at.x * scale_, ay = at.y * scale_, reach = std::hypot(width, height + ink->baseline);
  const double turn = turn_deg * kPi64 / 180, c = std::cos(turn), s = std::sin(turn);
  const auto texel = [&](int column, int row) {
    const bool is_inside = column >= 0 && column < ink->width && row >= 0 && row < ink->height;
    return is_inside ? double(ink->data[std::size_t(row) * std::size_t(ink->width) + std::size_t(column)])
                     : 0;
  };
  fill({ax - reach, ay - reach}, {ax + reach, ay + reach}, kInk, [&](double x, double y) {
    // Turned back into the text's own box, between four of its pixels.
    const double u = (x - ax) * c + (y - ay) * s + start - 0.5;
    const double v = (y - ay) * c - (x - ax) * s + ink->baseline - 0.5;
    const int column = int(std::floor(u)), row = int(std::floor(v));
    const double fu = u - column, fv = v - row;
    const double upper = texel(column, row) * (1 - fu) + texel(column + 1, row) * fu;
    const double lower = texel(column, row + 1) * (1 - fu) + texel(column + 1, row + 1) * fu;
    return float(upper * (1 - fv) + lower * fv);
  });
}

Image Drawing::image() const {
  Image linear = encoded_;
  for (float& value : linear.data) value = float(srgb_decode(double(value)));
  return linear;
}

}  // namespace spectrace
