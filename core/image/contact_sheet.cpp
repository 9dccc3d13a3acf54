// SPDX-License-Identifier: Apache-2.0
#include "core/image/contact_sheet.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/error.h"

namespace spectrace {

namespace {

constexpr int kGap = 8;               // pixels between cells and around the sheet
constexpr int kCaptionHeight = 28;    // pixels below each image
constexpr int kFontSize = 18;         // pixels; smaller for long captions
constexpr int kSmallestFontSize = 8;  // still legible
constexpr float kBackground = 0.02f;  // linear: a dark grey
constexpr float kInk = 0.8f;

struct Layout {
  int columns, rows, cell_width, cell_height, caption_height;

  [[nodiscard]] int left(std::size_t item) const {
    return kGap + static_cast<int>(item % static_cast<std::size_t>(columns)) * (cell_width + kGap);
  }
  [[nodiscard]] int top(std::size_t item) const {
    return kGap +
           static_cast<int>(item / static_cast<std::size_t>(columns)) * (cell_height + caption_height + kGap);
  }
};

Layout make_layout(std::span<const SheetItem> items, int columns) {
  const int count = static_cast<int>(items.size());
  if (columns <= 0) columns = static_cast<int>(std::ceil(std::sqrt(count)));
  columns = std::min(columns, count);
  Layout layout{columns, (count + columns - 1) / columns, 0, 0, 0};
  for (const SheetItem& item : items) {
    layout.cell_width = std::max(layout.cell_width, item.rgb.width);
    layout.cell_height = std::max(layout.cell_height, item.rgb.height);
  }
  return layout;
}

/// One channel of ink coverage, or nothing where text cannot be drawn.
std::optional<std::vector<float>> draw_caption(const std::string& caption, int width,
                                               const std::filesystem::path& font) {
  auto ink = text_coverage(caption, kFontSize, font);
  if (ink && ink->width > width) {
    ink = text_coverage(caption, std::max(kSmallestFontSize, kFontSize * width / ink->width), font);
  }
  if (!ink) return std::nullopt;
  std::vector<float> coverage(std::size_t(width) * kCaptionHeight);
  const int left = (width - ink->width) / 2, top = (kCaptionHeight - ink->height) / 2;
  for (int y = 0; y < ink->height; ++y) {
    for (int x = 0; x < ink->width; ++x) {
      const int at_x = left + x, at_y = top + y;
      if (at_x < 0 || at_x >= width || at_y < 0 || at_y >= kCaptionHeight) continue;
      coverage[std::size_t(at_y) * std::size_t(width) + std::size_t(at_x)] =
          ink->data[std::size_t(y) * std::size_t(ink->width) + std::size_t(x)];
    }
  }
  return coverage;
}

void blend_caption(Image& sheet, const std::vector<float>& coverage, int left, int top, int width) {
  for (int y = 0; y < kCaptionHeight; ++y) {
    for (int x = 0; x < width; ++x) {
      const float c = coverage[std::size_t(y) * width + x];
      for (std::size_t k = 0; k < 3; ++k) {
        float& pixel = sheet.at(left + x, top + y, k);
        pixel += c * (kInk - pixel);
      }
    }
  }
}

void copy_image(Image& sheet, const Image& image, int left, int top) {
  for (int y = 0; y < image.height; ++y) {
    std::copy_n(&image.data[image.index(0, y, 0)], std::size_t(image.width) * 3, &sheet.at(left, top + y, 0));
  }
}

}  // namespace

ContactSheet make_contact_sheet(std::span<const SheetItem> items, int columns,
                                const std::optional<std::filesystem::path>& font) {
  SPECTRACE_CHECK(!items.empty());
  Layout layout = make_layout(items, columns);

  std::vector<std::vector<float>> captions;
  for (const SheetItem& item : items) {
    SPECTRACE_CHECK(item.rgb.channels.size() == 3 && item.rgb.width > 0 && item.rgb.height > 0);
    if (!font) break;
    auto coverage = draw_caption(item.caption, layout.cell_width, *font);
    if (!coverage) break;
    captions.push_back(std::move(*coverage));
  }
  const bool has_captions = captions.size() == items.size();
  if (has_captions) layout.caption_height = kCaptionHeight;

  Image sheet(kGap + layout.columns * (layout.cell_width + kGap),
              kGap + layout.rows * (layout.cell_height + layout.caption_height + kGap), {"R", "G", "B"});
  std::fill(sheet.data.begin(), sheet.data.end(), kBackground);
  for (std::size_t i = 0; i < items.size(); ++i) {
    const Image& image = items[i].rgb;
    const int left = layout.left(i), top = layout.top(i);
    copy_image(sheet, image, left + (layout.cell_width - image.width) / 2,
               top + (layout.cell_height - image.height) / 2);
    if (has_captions) blend_caption(sheet, captions[i], left, top + layout.cell_height, layout.cell_width);
  }
  return {std::move(sheet), has_captions};
}

}  // namespace spectrace
