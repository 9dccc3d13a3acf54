// SPDX-License-Identifier: Apache-2.0
#include "renderer/film.h"

#include <algorithm>
#include <array>

#include "core/base/error.h"

namespace spectrace {

std::vector<std::size_t> FilmLayout::kept_slots() const {
  std::vector<std::size_t> kept;
  const auto keep = [&](std::size_t first, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) kept.push_back(first + i);
  };
  const std::size_t moments = aovs.lobes ? kMomentLayers : 1;
  keep(slots::kInvalid, 1);
  layers.for_each([&](Layer layer) { keep(slots::xyz(layer), 3); });
  if (aovs.halves) keep(slots::b_xyz(0), 3 * moments);
  if (aovs.variance) keep(slots::rgb_squares(0), 3 * moments);
  for (const std::size_t begin : {slots::kFeatures, slots::kFeatureSquares}) {
    if (begin == slots::kFeatureSquares && !aovs.feature_variance) continue;
    for (const Feature feature : kFeatureList) {
      if (aovs.has(feature)) keep(begin + feature_begin(feature), feature_size(feature));
    }
  }
  if (aovs.halves) keep(slots::kInvalidB, 1);
  if (aovs.extrapolated) keep(slots::kExtrapolated, 1);
  return kept;
}

namespace {

std::vector<Tile> make_tiles(int width, int height) {
  std::vector<Tile> tiles;
  for (int y = 0; y < height; y += Film::kTileSize) {
    for (int x = 0; x < width; x += Film::kTileSize) {
      tiles.push_back({x, y, std::min(x + Film::kTileSize, width), std::min(y + Film::kTileSize, height)});
    }
  }
  return tiles;
}

/// Where the slots of halves are among those kept.
std::vector<std::pair<std::size_t, std::size_t>> find_half_slots(const std::vector<std::size_t>& kept) {
  std::vector<std::pair<std::size_t, std::size_t>> found;
  for_each_half_slot([&](std::size_t b, std::size_t all) {
    const auto at = std::find(kept.begin(), kept.end(), b), from = std::find(kept.begin(), kept.end(), all);
    if (at != kept.end() && from != kept.end()) found.emplace_back(at - kept.begin(), from - kept.begin());
  });
  return found;
}

template <typename T>
void add_row(std::span<T> to, std::span<const T> row) {
  for (std::size_t i = 0; i < to.size(); ++i) to[i] += row[i];
}

}  // namespace

Film::Film(int width, int height, FilmLayout layout, SampleRange target)
    : width_(width),
      height_(height),
      layout_(std::move(layout)),
      target_(target),
      slots_(layout_.kept_slots()),
      half_slots_(find_half_slots(slots_)),
      tiles_(make_tiles(width, height)),
      ends_(tiles_.size(), target.leaves().first) {
  for (std::vector<MatteCounts>& counts : mattes_) counts.resize(tiles_.size());
  SPECTRACE_CHECK(target.first % kLeafSamples == 0 && target.first < target.last);
}

std::pair<std::uint64_t, std::uint64_t> Film::ends() const {
  const auto [least, most] = std::minmax_element(ends_.begin(), ends_.end());
  return {*least, *most};
}

std::uint64_t Film::samples(std::size_t tile) const {
  return std::min(ends_[tile] * kLeafSamples, target_.last) - target_.first;
}

void Film::reserve(std::uint64_t end_leaf) {
  const std::uint64_t first = target_.leaves().first;
  const std::size_t blocks = blocks_of({first, end_leaf - first}).size();
  const std::size_t pixels = std::size_t(width_) * std::size_t(height_);
  while (planes_.size() < blocks) {
    planes_.push_back({.rows = std::vector<double>(pixels * slots_.size()),
                       .bins = std::vector<float>(pixels * layout_.bins_per_pixel())});
  }
}

void Film::add(std::size_t tile, LeafRange block, const TileSums& sums) {
  SPECTRACE_CHECK(block.first == ends_[tile]);
  const std::uint64_t first = target_.leaves().first;
  const std::vector<LeafRange> before = blocks_of({first, block.first - first});
  // Halves on the left of what has come are joined with it.
  std::size_t keep = before.size();
  for (LeafRange joined = block; keep > 0 && are_halves(before[keep - 1], joined); --keep) {
    joined = {before[keep - 1].first, 2 * joined.count};
  }
  SPECTRACE_CHECK(keep < planes_.size());
  const std::size_t stride = slots_.size(), bin_stride = layout_.bins_per_pixel();
  std::size_t from = 0;
  for_each_pixel(tiles_[tile], [&](std::size_t pixel) {
    std::array<double, slots::kCount> sum{};
    const std::span<double> row = std::span(sum).first(stride);
    std::copy_n(&sums.rows[from * stride], stride, row.begin());
    for (std::size_t i = before.size(); i > keep; --i) {
      // All that has come so far is the right half of what it is joined to.
      std::array<double, slots::kCount> right = sum;
      add_row<double>(row, {&planes_[i - 1].rows[pixel * stride], stride});
      for (const auto& [b, all] : half_slots_) row[b] = right[all];
    }
    std::copy(row.begin(), row.end(), &planes_[keep].rows[pixel * stride]);
    if (bin_stride > 0) {
      Plane& plane = planes_[keep];
      std::vector<float> bins(&sums.bins[from * bin_stride], &sums.bins[from * bin_stride] + bin_stride);
      for (std::size_t i = before.size(); i > keep; --i) {
        add_row<float>(bins, {&planes_[i - 1].bins[pixel * bin_stride], bin_stride});
      }
      std::copy(bins.begin(), bins.end(), &plane.bins[pixel * bin_stride]);
    }
    ++from;
  });
  for (std::size_t m = 0; m < kMatteKinds; ++m) {
    if (!sums.mattes[m].empty()) mattes_[m][tile] = sum_of(mattes_[m][tile], sums.mattes[m]);
  }
  ends_[tile] = block.end();
}

std::vector<LeafRange> Film::blocks(std::size_t tile) const {
  const std::uint64_t first = target_.leaves().first;
  return blocks_of({first, ends_[tile] - first});
}

std::uint64_t Film::samples_in_half_b(std::size_t tile) const {
  std::uint64_t count = 0;
  for (const LeafRange& block : blocks(tile)) {
    const std::uint64_t end = std::min(block.end() * kLeafSamples, target_.last);
    count += spectrace::samples_in_half_b(block, end - block.first * kLeafSamples);
  }
  return count;
}

std::span<const Film::Plane> Film::planes() const {
  std::size_t used = 0;
  for (std::size_t tile = 0; tile < tiles_.size(); ++tile) used = std::max(used, blocks(tile).size());
  return std::span(planes_).first(used);
}

bool Film::restore(std::vector<std::uint64_t> ends, std::vector<Plane> planes,
                   const std::array<MatteCounts, kMatteKinds>& mattes) {
  const LeafRange target = target_.leaves();
  const std::size_t pixels = std::size_t(width_) * std::size_t(height_);
  if (ends.size() != tiles_.size()) return false;
  for (const std::uint64_t end : ends) {
    if (end < target.first || end > target.end()) return false;
    if (blocks_of({target.first, end - target.first}).size() > planes.size()) return false;
  }
  for (const Plane& plane : planes) {
    if (plane.rows.size() != pixels * slots_.size()) return false;
    if (plane.bins.size() != pixels * layout_.bins_per_pixel()) return false;
  }
  auto restored = mattes_;
  for (std::size_t m = 0; m < kMatteKinds; ++m) {
    auto parted = by_tiles(mattes[m], ends);
    if (!parted) return false;
    restored[m] = std::move(*parted);
  }
  mattes_ = std::move(restored);
  ends_ = std::move(ends);
  planes_ = std::move(planes);
  return true;
}

bool Film::set_last(std::uint64_t last_sample) {
  const SampleRange changed{target_.first, last_sample};
  if (changed == target_) return true;
  const bool is_cut = target_.last % kLeafSamples != 0 && ends().second == target_.leaves().end();
  if (is_cut || last_sample <= target_.first || ends().second * kLeafSamples > last_sample) return false;
  target_ = changed;
  return true;
}

void Film::append(const Film& next) {
  SPECTRACE_CHECK(is_complete() && next.is_complete() && next.layout_ == layout_);
  SPECTRACE_CHECK(next.target_.first == target_.last && next.width_ == width_ && next.height_ == height_);
  target_.last = next.target_.last;
  const std::vector<LeafRange> blocks = blocks_of(next.target_.leaves());
  const std::size_t stride = slots_.size(), bins = layout_.bins_per_pixel();
  TileSums sums;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    reserve(blocks[b].end());
    const Plane& plane = next.planes_[b];
    for (std::size_t tile = 0; tile < tiles_.size(); ++tile) {
      sums.rows.clear();
      sums.bins.clear();
      for_each_pixel(tiles_[tile], [&](std::size_t pixel) {
        const auto row = plane.rows.begin() + std::ptrdiff_t(pixel * stride);
        sums.rows.insert(sums.rows.end(), row, row + std::ptrdiff_t(stride));
        const auto bin = plane.bins.begin() + std::ptrdiff_t(pixel * bins);
        sums.bins.insert(sums.bins.end(), bin, bin + std::ptrdiff_t(bins));
      });
      add(tile, blocks[b], sums);
    }
  }
  for (std::size_t m = 0; m < kMatteKinds; ++m) {
    for (std::size_t tile = 0; tile < tiles_.size(); ++tile) {
      mattes_[m][tile] = sum_of(mattes_[m][tile], next.mattes_[m][tile]);
    }
  }
}

std::uint64_t Film::invalid_samples() const {
  SPECTRACE_CHECK(slots_.front() == slots::kInvalid);
  double total = 0;
  for (std::size_t tile = 0; tile < tiles_.size(); ++tile) {
    const std::size_t count = blocks(tile).size();
    for_each_pixel(tiles_[tile], [&](std::size_t pixel) {
      for (std::size_t b = 0; b < count; ++b) total += planes_[b].rows[pixel * slots_.size()];
    });
  }
  return std::uint64_t(total);
}

}  // namespace spectrace
