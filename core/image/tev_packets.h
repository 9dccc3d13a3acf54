// SPDX-License-Identifier: Apache-2.0
// tev's packets: u32 length of the whole, u8 type, payload; little endian, strings end in a zero. Internal to
// core/image.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "core/image/image.h"

namespace spectrace {

inline constexpr int kTevTile = 128;  // pixels; small enough to skip what rests, large enough to cost little

struct TevTile {
  int x = 0, y = 0, width = 0, height = 0;
};

/// CreateImage (4): an empty picture of that name; one that is there is replaced.
[[nodiscard]] std::vector<std::byte> tev_create(const std::string& name, const Image& image);
/// UpdateImageV3 (6): all channels of one tile, interleaved.
[[nodiscard]] std::vector<std::byte> tev_update(const std::string& name, const Image& image,
                                                const TevTile& tile);

/// The tiles of `image` whose bits differ from `before`; all where that has another size or other channels.
[[nodiscard]] std::vector<TevTile> changed_tiles(const Image& image, const Image& before);

}  // namespace spectrace
