// SPDX-License-Identifier: Apache-2.0
#include "core/image/text_coverage.h"

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include <string>
#include <system_error>

namespace spectrace {

namespace {

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

std::optional<TextCoverage> text_coverage(std::string_view text, int size_pixels,
                                          const std::filesystem::path& font) {
  const std::string ascii = drawable(text);
  if (ascii.find_first_not_of(' ') == std::string::npos) return TextCoverage{};
  const OIIO::ROI extent = OIIO::ImageBufAlgo::text_size(ascii, size_pixels, font.string());
  if (!extent.defined()) return std::nullopt;
  TextCoverage coverage{
      .width = extent.width(), .height = extent.height(), .baseline = -extent.ybegin, .data = {}};
  OIIO::ImageBuf buffer(OIIO::ImageSpec(coverage.width, coverage.height, 1, OIIO::TypeDesc::FLOAT));
  constexpr float kFullCoverage[] = {1.0f};
  coverage.data.resize(std::size_t(coverage.width) * std::size_t(coverage.height));
  const bool is_drawn = OIIO::ImageBufAlgo::zero(buffer) &&
                        OIIO::ImageBufAlgo::render_text(buffer, -extent.xbegin, -extent.ybegin, ascii,
                                                        size_pixels, font.string(), kFullCoverage) &&
                        buffer.get_pixels(buffer.roi(), OIIO::TypeDesc::FLOAT, coverage.data.data());
  if (!is_drawn) {
    static_cast<void>(buffer.geterror());  // fetched, or OpenImageIO prints it
    return std::nullopt;
  }
  return coverage;
}

}  // namespace spectrace
