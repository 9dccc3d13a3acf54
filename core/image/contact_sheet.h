// SPDX-License-Identifier: Apache-2.0
// Several images side by side in one, with captions.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "core/image/image.h"
#include "core/image/text_coverage.h"

namespace spectrace {

struct SheetItem {
  Image rgb;            ///< R, G, B, linear; drawn as they are, non-finite pixels too
  std::string caption;  ///< one line of ASCII, other characters become '?'; smaller where it is too wide
};

struct ContactSheet {
  Image image;  ///< R, G, B, linear
  bool has_captions = false;
};

/// At least one item, row by row in `columns` columns (0: as near to a square as it gets); each cell as large
/// as the largest image, images in its middle. Without a font, or where OpenImageIO was built without
/// FreeType, there are no captions and no room for them.
ContactSheet make_contact_sheet(std::span<const SheetItem> items, int columns = 0,
                                const std::optional<std::filesystem::path>& font = find_caption_font());

}  // namespace spectrace
