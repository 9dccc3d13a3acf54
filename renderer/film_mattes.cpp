// SPDX-License-Identifier: Apache-2.0
// A film's counts of what its pixels show. They are integers: added up without regard to blocks of samples.
#include <algorithm>

#include "renderer/film.h"

namespace spectrace {

std::size_t Film::tile_of(std::uint32_t pixel) const {
  const std::size_t x = pixel % std::uint32_t(width_), y = pixel / std::uint32_t(width_);
  const std::size_t tiles_across = (std::size_t(width_) + kTileSize - 1) / kTileSize;
  return y / kTileSize * tiles_across + x / kTileSize;
}

MatteCounts Film::matte_counts(Matte matte) const {
  MatteCounts all;
  for (const MatteCounts& counts : mattes_[std::size_t(matte)]) {
    all.insert(all.end(), counts.begin(), counts.end());
  }
  return all;
}

std::optional<std::vector<MatteCounts>> Film::by_tiles(const MatteCounts& counts,
                                                       const std::vector<std::uint64_t>& ends) const {
  const std::size_t pixels = std::size_t(width_) * std::size_t(height_);
  std::vector<MatteCounts> parted(tiles_.size());
  std::uint64_t in_pixel = 0;
  for (const MatteCount& count : counts) {
    if (count.pixel >= pixels) return std::nullopt;
    const std::size_t tile = tile_of(count.pixel);
    MatteCounts& of_tile = parted[tile];
    if (!of_tile.empty() && !comes_before(of_tile.back(), count)) return std::nullopt;
    const bool is_first = of_tile.empty() || of_tile.back().pixel != count.pixel;
    const std::uint64_t taken = std::min(ends[tile] * kLeafSamples, target_.last) - target_.first;
    const std::uint64_t left = is_first ? taken : taken - in_pixel;
    if (count.samples == 0 || count.samples > left) return std::nullopt;
    in_pixel = taken - left + count.samples;
    of_tile.push_back(count);
  }
  return parted;
}

void Film::resolve_matte(Matte matte, const std::vector<double>& valid, std::size_t first_channel,
                         Image& image) const {
  for (const MatteCounts& counts : mattes_[std::size_t(matte)]) {
    for (auto begin = counts.begin(); begin != counts.end();) {
      const std::uint32_t pixel = begin->pixel;
      const auto end =
          std::find_if(begin, counts.end(), [&](const MatteCount& count) { return count.pixel != pixel; });
      float* const ranks = &image.data[std::size_t(pixel) * image.channels.size() + first_channel];
      write_ranks({begin, end}, valid[pixel], {ranks, 2 * kMatteRanks});
      begin = end;
    }
  }
}

}  // namespace spectrace
