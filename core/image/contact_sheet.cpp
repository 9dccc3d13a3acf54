// SPDX-License-Identifier: Apache-2.0
#include "core/image/contact_sheet.h"

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
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

/// OpenImageIO 2.4 draws wrong glyphs for anything beyond ASCII: better a '?' than another text.
std::string drawable(std::string_view text) {
  std::string ascii;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x80 && byte < 0xC0) continue;  // the rest of a UTF-8 character
    ascii += byte >= 0x20 && byte < 0x7f ? c : '?';
  }
  return ascii;
}

/// One channel of ink coverage, or nothing where text cannot be drawn.
std::optional<std::vector<float>> draw_caption(const std::string& caption, int width,
                                               const std::string& font) {
  OIIO::ImageBuf buffer(OIIO::ImageSpec(width, kCaptionHeight, 1, OIIO::TypeDesc::FLOAT));
  if (!OIIO::ImageBufAlgo::zero(buffer)) return std::nullopt;
  int size = kFontSize;
  const OIIO::ROI extent = OIIO::ImageBufAlgo::text_size(caption, size, font);
  if (!extent.defined() && !caption.empty()) return std::nullopt;
  if (!caption.empty() && extent.width() > width) {
    size = std::max(kSmallestFontSize, size * width / extent.width());
  }
  constexpr float kFullCoverage[] = {1.0f};
  const bool is_drawn = OIIO::ImageBufAlgo::render_text(
      buffer, width / 2, kCaptionHeight / 2, caption, size, font, kFullCoverage,
      OIIO::ImageBufAlgo::TextAlignX::Center, OIIO::ImageBufAlgo::TextAlignY::Center);
  std::vector<float> coverage(std::size_t(width) * kCaptionHeight);
  if (!is_drawn || !buffer.get_pixels(buffer.roi(), OIIO::TypeDesc::FLOAT, coverage.data())) {
    static_cast<void>(buffer.geterror());  // fetched, or OpenImageIO prints it
    return std::nullopt;
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

std::optional<std::filesystem::path> find_caption_font() {
  // Debian and Ubuntu; Fedora; Arch.
  for (const char* file :
       {"/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",
        "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans.ttf", "/usr/share/fonts/TTF/DejaVuSans.ttf"}) {
    std::error_code ignored;
    if (std::filesystem::is_regular_file(file, ignored)) return file;
  }
  return std::nullopt;
}

ContactSheet make_contact_sheet(std::span<const SheetItem> items, int columns,
                                const std::optional<std::filesystem::path>& font) {
  SPECTRACE_CHECK(!items.empty());
  Layout layout = make_layout(items, columns);

  std::vector<std::vector<float>> captions;
  for (const SheetItem& item : items) {
    SPECTRACE_CHECK(item.rgb.channels.size() == 3 && item.rgb.width > 0 && item.rgb.height > 0);
    if (!font) break;
    auto coverage = draw_caption(drawable(item.caption), layout.cell_width, font->string());
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
