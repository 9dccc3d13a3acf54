// SPDX-License-Identifier: Apache-2.0
// Sums by pixel, and the images they make; box filter: a sample counts for the pixel it falls in.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/image/image.h"
#include "renderer/aovs.h"
#include "renderer/layers.h"
#include "renderer/matte.h"
#include "renderer/sample_range.h"
#include "renderer/spectral_bins.h"

namespace spectrace {

/// Pixels [x0, x1) x [y0, y1) of a film.
struct Tile {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;

  [[nodiscard]] std::size_t pixels() const { return std::size_t(x1 - x0) * std::size_t(y1 - y0); }
  friend constexpr bool operator==(const Tile&, const Tile&) = default;
};

/// Which numbers of a pixel's row (renderer/pixel_sums.h) are kept, and spectral bins beside them.
struct FilmLayout {
  LayerSet layers = kBeautyLayer;
  AovSet aovs;
  std::optional<SpectralBins> bins;
  LayerSet bin_layers;

  friend bool operator==(const FilmLayout&, const FilmLayout&) = default;

  /// Places of the row, in order.
  [[nodiscard]] std::vector<std::size_t> kept_slots() const;
  [[nodiscard]] std::size_t bins_per_pixel() const { return bins ? bin_layers.size() * bins->count : 0; }
};

/// What one block of samples of a tile comes to: pixel by pixel.
struct TileSums {
  std::vector<double> rows;  ///< [pixel][kept slot]
  std::vector<float> bins;  ///< [pixel][layer][bin]: radiance [W·m⁻²·sr⁻¹·nm⁻¹] summed over samples
  std::array<MatteCounts, kMatteKinds> mattes{};  ///< of those that the layout has
};

/// Sums of each tile over the samples it has so far, a range of leaves that begins at the same one for all
/// and may end at different ones. They are kept by the blocks the range consists of (ADR 0014): as many
/// numbers a pixel as the layout keeps, 8 bytes each, 4 a spectral bin, times the number of blocks, which is
/// one for 2^k · 8 samples from the first on.
/// Tiles may be added to from several threads as long as each tile has one and reserve() has gone before.
class Film {
 public:
  static constexpr int kTileSize =
      16;  // pixels: small enough to share the last tiles out, large enough to amortise

  Film(int width, int height, FilmLayout layout, SampleRange target);

  /// What such a film comes to hold, and beside it the largest of its images while that is written.
  [[nodiscard]] static std::uint64_t memory_bytes(int width, int height, const FilmLayout& layout,
                                                  SampleRange target);

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  [[nodiscard]] const FilmLayout& layout() const { return layout_; }
  [[nodiscard]] std::span<const Tile> tiles() const { return tiles_; }
  /// What it is to hold in the end.
  [[nodiscard]] SampleRange target() const { return target_; }
  /// The leaf after the last one that the tile holds.
  [[nodiscard]] std::uint64_t end(std::size_t tile) const { return ends_[tile]; }
  /// The first end and the last one of all tiles.
  [[nodiscard]] std::pair<std::uint64_t, std::uint64_t> ends() const;
  /// Samples a pixel of the tile holds, invalid ones included.
  [[nodiscard]] std::uint64_t samples(std::size_t tile) const;

  /// Makes room for what the film is once all tiles end at `end_leaf`.
  void reserve(std::uint64_t end_leaf);
  /// `block` begins where the tile ends.
  void add(std::size_t tile, LeafRange block, const TileSums& sums);

  /// R,G,B, and what the layout holds beside: channels by docs/aovs.md.
  [[nodiscard]] Image resolve() const;
  /// Mean spectra of one layer; R,G,B of the same beside them.
  [[nodiscard]] Image resolve_spectral(Layer layer) const;
  [[nodiscard]] std::uint64_t invalid_samples() const;
  /// How far the beauty is off by its noise, as its halves A and B tell: sqrt(mean(((A - B) / 2)² / (M² +
  /// m²))) over pixels and R, G, B, where M is the pixel's mean and m a tenth of the image's: the root of
  /// relMSE with an epsilon of m². Infinity where half B is empty: of one sample. The layout must have
  /// halves.
  [[nodiscard]] double relative_error() const;

  /// One block of every tile.
  struct Plane {
    std::vector<double> rows;  ///< [pixel][kept slot]
    std::vector<float> bins;   ///< [pixel][layer][bin]
  };
  [[nodiscard]] std::span<const Plane> planes() const;
  [[nodiscard]] const std::vector<std::uint64_t>& ends_by_tile() const { return ends_; }
  /// Of all pixels, tile by tile.
  [[nodiscard]] MatteCounts matte_counts(Matte matte) const;
  /// What those three gave, of a film made alike. False, and nothing done, where they do not fit.
  [[nodiscard]] bool restore(std::vector<std::uint64_t> ends, std::vector<Plane> planes,
                             const std::array<MatteCounts, kMatteKinds>& mattes);

  [[nodiscard]] bool is_complete() const { return ends().first == target_.leaves().end(); }
  /// A later end, or an earlier one that is not passed yet. False, and nothing done, where samples beyond it
  /// are there, or where the last leaf was cut short.
  [[nodiscard]] bool set_last(std::uint64_t last_sample);
  /// Of the same image: the samples after this one's. Both must be complete.
  void append(const Film& next);

 private:
  /// Visits the pixels of a tile with their index.
  template <typename Visit>
  void for_each_pixel(const Tile& tile, const Visit& visit) const {
    for (int y = tile.y0; y < tile.y1; ++y) {
      for (int x = tile.x0; x < tile.x1; ++x) visit(std::size_t(y) * std::size_t(width_) + std::size_t(x));
    }
  }
  /// Visits each pixel with its index and PixelTotal.
  template <typename Visit>
  void for_each_total(const Visit& visit) const;
  /// What a tile consists of.
  [[nodiscard]] std::vector<LeafRange> blocks(std::size_t tile) const;
  [[nodiscard]] std::uint64_t samples_in_half_b(std::size_t tile) const;
  [[nodiscard]] std::size_t tile_of(std::uint32_t pixel) const;
  /// Counts parted by tiles; nothing where they do not fit the film, whose tiles end at `ends`.
  [[nodiscard]] std::optional<std::vector<MatteCounts>> by_tiles(
      const MatteCounts& counts, const std::vector<std::uint64_t>& ends) const;
  /// Fills the channels from `first_channel` on. `valid`: samples of each pixel that count.
  void resolve_matte(Matte matte, const std::vector<double>& valid, std::size_t first_channel,
                     Image& image) const;

  int width_, height_;
  FilmLayout layout_;
  SampleRange target_;
  std::vector<std::size_t> slots_;                               // of a row, kept
  std::vector<std::pair<std::size_t, std::size_t>> half_slots_;  // kept ones of for_each_half_slot()
  std::vector<Tile> tiles_;
  std::vector<std::uint64_t> ends_;
  std::vector<Plane> planes_;  // the n-th block of each tile
  std::array<std::vector<MatteCounts>, kMatteKinds>
      mattes_;  // by tile; of those the layout does not have, empty
};

}  // namespace spectrace
