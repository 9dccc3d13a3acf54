// SPDX-License-Identifier: Apache-2.0
#include "renderer/film.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/spectra/color.h"

namespace spectrace::test {
namespace {

constexpr int kWidth = 20, kHeight = 17;  // four tiles, three of them cut

FilmLayout layout() {
  FilmLayout l{.layers = kBeautyLayer | kLobeLayers, .aovs = kDenoiseAovs, .bins = {}, .bin_layers = {}};
  l.aovs.crypto_object = true;
  l.bins = SpectralBins{.range = {400, 700}, .count = 5};
  l.bin_layers = LayerSet(Layer::kBeauty, Layer::kDiffuse);
  return l;
}

/// Sums of one leaf of one tile: any numbers, but the same whenever asked for.
TileSums leaf(const Film& film, std::size_t tile, std::uint64_t index) {
  std::mt19937 random(unsigned(tile * 1000 + index));
  std::uniform_real_distribution<double> exponent(-8, 8);
  const std::size_t pixels = film.tiles()[tile].pixels();
  TileSums sums;
  sums.rows.resize(pixels * film.layout().kept_slots().size());
  sums.bins.resize(pixels * film.layout().bins_per_pixel());
  for (double& x : sums.rows) x = std::exp2(exponent(random));
  for (float& x : sums.bins) x = float(std::exp2(exponent(random)));
  for (std::size_t p = 0; p < pixels; ++p) {
    sums.rows[p * film.layout().kept_slots().size()] = 0;  // nothing invalid
  }
  const Tile& place = film.tiles()[tile];
  for (int y = place.y0; y < place.y1; ++y) {
    for (int x = place.x0; x < place.x1; ++x) {
      const auto pixel = std::uint32_t(y * kWidth + x);
      const std::uint32_t id = matte_id("object " + std::to_string(random() % 3));
      sums.mattes[std::size_t(Matte::kObject)].push_back({pixel, id, 1 + random() % kLeafSamples});
    }
  }
  return sums;
}

void render(Film& film, std::uint64_t first, std::uint64_t end) {
  for (std::uint64_t i = first; i < end; ++i) {
    film.reserve(i + 1);
    for (std::size_t tile = 0; tile < film.tiles().size(); ++tile) {
      film.add(tile, {i, 1}, leaf(film, tile, i));
    }
  }
}

Film rendered(SampleRange samples) {
  Film film(kWidth, kHeight, layout(), samples);
  render(film, samples.leaves().first, samples.leaves().end());
  return film;
}

void expect_same(const Film& a, const Film& b) {
  EXPECT_EQ(a.resolve().data, b.resolve().data);
  for (Layer layer : {Layer::kBeauty, Layer::kDiffuse}) {
    EXPECT_EQ(a.resolve_spectral(layer).data, b.resolve_spectral(layer).data);
  }
}

TEST(Film, PartsJoinToTheBitsOfTheWhole) {
  for (std::uint64_t last : {64U, 104U, 101U}) {
    const Film whole = rendered({0, last});
    for (const std::vector<std::uint64_t>& cuts :
         std::vector<std::vector<std::uint64_t>>{{32}, {8}, {24, 56}, {8, 16, 24, 32, 40, 48, 56}}) {
      Film joined = rendered({0, cuts.front()});
      for (std::size_t i = 0; i < cuts.size(); ++i) {
        joined.append(rendered({cuts[i], i + 1 < cuts.size() ? cuts[i + 1] : last}));
      }
      expect_same(joined, whole);
      EXPECT_EQ(joined.planes().size(), whole.planes().size());
    }
  }
}

TEST(Film, JoiningIsAssociative) {
  Film left = rendered({0, 24});
  left.append(rendered({24, 40}));
  left.append(rendered({40, 96}));
  Film right = rendered({24, 40});
  right.append(rendered({40, 96}));
  Film all = rendered({0, 24});
  all.append(right);
  expect_same(left, all);
}

TEST(Film, OfWholePowersOfTwoNeedsOnePlane) {
  EXPECT_EQ(rendered({0, 64}).planes().size(), 1U);
  EXPECT_EQ(rendered({64, 128}).planes().size(), 1U);
  EXPECT_EQ(rendered({0, 56}).planes().size(), 3U);
}

TEST(Film, GoesOnWhereItWasRestored) {
  const Film whole = rendered({0, 80});
  Film half(kWidth, kHeight, layout(), {0, 80});
  render(half, 0, 3);
  half.reserve(4);
  half.add(1, {3, 1}, leaf(half, 1, 3));  // one tile is ahead
  Film restored(kWidth, kHeight, layout(), {0, 80});
  ASSERT_TRUE(restored.restore(half.ends_by_tile(), {half.planes().begin(), half.planes().end()},
                               {half.matte_counts(Matte::kObject), {}}));
  for (std::size_t tile = 0; tile < restored.tiles().size(); ++tile) {
    for (std::uint64_t i = restored.end(tile); i < 10; ++i) {
      restored.reserve(i + 1);
      restored.add(tile, {i, 1}, leaf(restored, tile, i));
    }
  }
  expect_same(restored, whole);
}

TEST(Film, RefusesToRestoreWhatDoesNotFit) {
  const Film whole = rendered({0, 56});
  const std::vector<Film::Plane> planes(whole.planes().begin(), whole.planes().end());
  const auto restores = [&](std::vector<std::uint64_t> ends, std::vector<Film::Plane> from) {
    return Film(kWidth, kHeight, layout(), {0, 56})
        .restore(std::move(ends), std::move(from), {whole.matte_counts(Matte::kObject), {}});
  };
  EXPECT_TRUE(restores(whole.ends_by_tile(), planes));
  EXPECT_FALSE(restores({7, 7, 7}, planes)) << "a tile too few";
  EXPECT_FALSE(restores({7, 7, 7, 8}, planes)) << "beyond the last sample";
  EXPECT_FALSE(restores(whole.ends_by_tile(), {planes[0], planes[1]})) << "a block too few";
  std::vector<Film::Plane> cut = planes;
  cut[2].rows.pop_back();
  EXPECT_FALSE(restores(whole.ends_by_tile(), cut));
}

TEST(Film, RefusesToRestoreCountsThatDoNotFit) {
  const Film whole = rendered({0, 56});
  const auto restores = [&](const auto& change) {
    MatteCounts counts = whole.matte_counts(Matte::kObject);
    change(counts);
    return Film(kWidth, kHeight, layout(), {0, 56})
        .restore(whole.ends_by_tile(), {whole.planes().begin(), whole.planes().end()}, {counts, {}});
  };
  EXPECT_TRUE(restores([](MatteCounts&) {}));
  EXPECT_TRUE(restores([](MatteCounts& counts) { counts.clear(); })) << "nothing was hit";
  EXPECT_FALSE(restores([](MatteCounts& counts) { counts[5].pixel = kWidth * kHeight; })) << "no such pixel";
  EXPECT_FALSE(restores([](MatteCounts& counts) { std::swap(counts[5], counts[6]); })) << "out of order";
  EXPECT_FALSE(restores([](MatteCounts& counts) { counts[5] = counts[4]; })) << "twice";
  EXPECT_FALSE(restores([](MatteCounts& counts) { counts[5].samples = 0; })) << "none";
  EXPECT_FALSE(restores([](MatteCounts& counts) { counts[5].samples = 57; })) << "more than were taken";
  EXPECT_FALSE(restores([](MatteCounts& counts) {
    // Each of them fits, both together do not.
    counts = {{0, 1, 30}, {0, 2, 27}};
  }));
  EXPECT_TRUE(restores([](MatteCounts& counts) { counts = {{0, 1, 30}, {0, 2, 26}}; }));
}

TEST(Film, MayGoOnToMoreSamplesUnlessTheLastLeafWasCut) {
  Film film = rendered({0, 64});
  EXPECT_TRUE(film.set_last(64));
  EXPECT_FALSE(film.set_last(56)) << "they are there already";
  EXPECT_TRUE(film.set_last(100));
  EXPECT_FALSE(film.is_complete());
  Film cut = rendered({0, 60});
  EXPECT_FALSE(cut.set_last(64));
  EXPECT_TRUE(cut.set_last(60));
}

/// One pixel of one tile with given sums.
TEST(Film, TellsMeansHalvesAndVariances) {
  FilmLayout l{.layers = kBeautyLayer, .aovs = {}, .bins = {}, .bin_layers = {}};
  l.aovs.halves = l.aovs.variance = true;
  Film film(1, 1, l, {0, 8});
  // Samples 0..7 of grey: beauty of sample i is i³ in R, G and B.
  const Xyz unit = rgb_to_xyz({1, 1, 1});
  std::vector<double> full(slots::kCount);
  for (int i = 0; i < 8; ++i) {
    const double x = i * i * i;
    for (std::size_t c = 0; c < 3; ++c) {
      full[slots::xyz(Layer::kBeauty) + c] += x * unit[c];
      if (i >= 4) full[slots::b_xyz(0) + c] += x * unit[c];
      full[slots::rgb_squares(0) + c] += x * x;
    }
  }
  TileSums sums;
  for (std::size_t slot : l.kept_slots()) sums.rows.push_back(full[slot]);
  film.reserve(1);
  film.add(0, {0, 1}, sums);
  const Image image = film.resolve();
  const auto value = [&](const char* channel) { return image.at(0, 0, image.find_channel(channel).value()); };
  EXPECT_NEAR(value("R"), 98, 1e-4);
  EXPECT_NEAR(value("beauty_a.G"), 9, 1e-4);                          // samples 0 to 3
  EXPECT_NEAR(value("beauty_b.B"), 187, 1e-4);                        // samples 4 to 7
  EXPECT_NEAR(value("beauty_variance.R"), 107988.0 / (8 * 7), 1e-2);  // Σ(x - 98)² = 107988
  // (187 - 9) / 2 over the pixel, floor of a tenth of the same
  EXPECT_NEAR(film.relative_error(), 89 / (98 * std::sqrt(1 + 1e-2)), 1e-6);
}

}  // namespace
}  // namespace spectrace::test
