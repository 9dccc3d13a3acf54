// SPDX-License-Identifier: Apache-2.0
#include "core/image/texture_cache.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <string>
#include <thread>
#include <tuple>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/image/area_means.h"
#include "tests/support/chi_square.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"

namespace spectrace {
namespace {

using test::TemporaryFolder;
using test::write_text;

Image random_image(int width, int height, std::size_t channels) {
  Image image(width, height, {});
  for (std::size_t c = 0; c < channels; ++c) image.channels.push_back(std::string(1, "RGBA"[c]));
  image.data.resize(std::size_t(width) * std::size_t(height) * channels);
  test::TestRandom random(7);
  for (float& x : image.data) x = float(random.uniform());
  return image;
}

double mean_of(const Image& image, std::size_t channel) {
  double sum = 0;
  for (std::size_t i = channel; i < image.data.size(); i += image.channels.size())
    sum += double(image.data[i]);
  return sum / (double(image.width) * image.height);
}

/// Texel centres lie at .5; row 0 is at the top, v = 0 at the bottom.
double bilinear(const Image& image, Vec2 uv, std::size_t c) {
  const double x = double(uv.x) * image.width - 0.5, y = (1 - double(uv.y)) * image.height - 0.5;
  const auto texel = [&](double column, double row) {
    const auto wrapped = [](double i, int n) { return int(i - std::floor(i / n) * n); };
    return double(image.at(wrapped(column, image.width), wrapped(row, image.height), c));
  };
  const double left = std::floor(x), top = std::floor(y), a = x - left, b = y - top;
  return (1 - b) * ((1 - a) * texel(left, top) + a * texel(left + 1, top)) +
         b * ((1 - a) * texel(left, top + 1) + a * texel(left + 1, top + 1));
}

Footprint round_footprint(Float diameter) { return {{diameter, 0}, {0, diameter}}; }

float value(const CachedImage& image, Vec2 uv, const Footprint& over, std::size_t channel = 0) {
  float x = -1;
  image.mean(uv, over, channel, 1, &x);
  return x;
}

/// Restores the limit that other tests have.
struct CacheLimit {
  explicit CacheLimit(std::size_t mebibytes) { set_texture_cache_limit(mebibytes); }
  ~CacheLimit() { set_texture_cache_limit(kTextureCacheMiB); }
  CacheLimit(const CacheLimit&) = delete;
  CacheLimit& operator=(const CacheLimit&) = delete;
};

TEST(AreaMeans, KeepTheMeanWhateverTheSizes) {
  const std::array<AreaMeans::Size, 4> fine{{{5, 3}, {8, 8}, {1, 7}, {31, 17}}};
  const std::array<AreaMeans::Size, 4> coarse{{{2, 1}, {4, 4}, {1, 3}, {7, 17}}};
  for (std::size_t i = 0; i < fine.size(); ++i) {
    const Image image = random_image(fine[i].width, fine[i].height, 2);
    AreaMeans means(fine[i], coarse[i], 0, coarse[i].height, 2);
    for (int y = 0; y < fine[i].height; ++y) means.add(y, &image.data[image.index(0, y, 0)]);
    Image result(coarse[i].width, coarse[i].height, {"R", "G"});
    result.data = means.means();
    for (std::size_t c = 0; c < 2; ++c) EXPECT_NEAR(mean_of(result, c), mean_of(image, c), 1e-6);
  }
}

TEST(AreaMeans, OfARampAreARamp) {
  // Five texels to two: the third is shared by both.
  AreaMeans means({5, 1}, {2, 1}, 0, 1, 1);
  const std::array<float, 5> ramp{0, 1, 2, 3, 4};
  means.add(0, ramp.data());
  EXPECT_EQ(means.means(), (std::vector<float>{0.8F, 3.2F}));  // (0 + 1 + 2 / 2) / 2.5
}

TEST(AreaMeans, AskOnlyForTheRowsOfAStrip) {
  const AreaMeans strip({4, 100}, {2, 50}, 10, 12, 1);
  EXPECT_EQ(strip.first_row(), 20);
  EXPECT_EQ(strip.last_row(), 24);
  const AreaMeans odd({4, 5}, {2, 2}, 1, 2, 1);
  EXPECT_EQ(odd.first_row(), 2);
  EXPECT_EQ(odd.last_row(), 5);
}

TEST(TextureCache, APointIsBilinear) {
  for (const auto& [width, height] :
       {std::pair(4, 4), std::pair(37, 11), std::pair(300, 500), std::pair(1, 9)}) {
    const Image image = random_image(width, height, 3);
    const CachedImage cached(image);
    test::TestRandom random(3);
    for (int i = 0; i < 2000; ++i) {
      const Vec2 uv{Float(random.uniform()), Float(random.uniform())};
      std::array<float, 3> rgb{};
      cached.mean(uv, kPointFootprint, 0, 3, rgb.data());
      // The library places texels in single precision: 500 · 2^-24 of a texel; largest seen 1.5e-5.
      for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(rgb[c], bilinear(image, uv, c), 5e-5);
      EXPECT_EQ(value(cached, uv, round_footprint(Float(1) / 1000)), rgb[0])
          << "below a texel nothing is blurred";
    }
  }
}

TEST(TextureCache, FootprintsAverage) {
  const Image image = random_image(256, 256, 1);
  const CachedImage cached(image);
  const auto spread = [&](const Footprint& over) {
    test::TestRandom random(3);
    double sum = 0, squares = 0;
    constexpr int kLookups = 4000;
    for (int i = 0; i < kLookups; ++i) {
      const double x = double(value(cached, {Float(random.uniform()), Float(random.uniform())}, over));
      sum += x;
      squares += x * x;
    }
    const double mean = sum / kLookups;
    // Of the texels and of the places: (1/12) / lookups, 4 sigma.
    EXPECT_NEAR(mean, mean_of(image, 0), 4 * std::sqrt(1.0 / 12 / kLookups));
    return squares / kLookups - mean * mean;
  };
  const double point = spread(kPointFootprint);
  for (const Float texels : {4, 8, 16}) {
    const Float d = texels / 256;
    const double round = spread(round_footprint(d));
    // Of independent texels the variance is that of one by their number; a bilinear blend holds about two.
    EXPECT_LT(round, 2 * point / double(texels * texels));
    EXPECT_GT(round, point / double(texels * texels) / 4) << "no wider than asked for";
    const double along_u = spread({{4 * d, 0}, {0, d}}), along_v = spread({{0, 4 * d}, {d, 0}});
    EXPECT_LT(along_u, round / 2);
    EXPECT_LT(along_v, round / 2);
    EXPECT_GT(along_u, round / 8) << "wide along one axis only";
  }
  EXPECT_NEAR(value(cached, {Float(0.3), Float(0.8)}, round_footprint(2)), mean_of(image, 0), 1e-6);
}

TEST(TextureCache, LongFootprintsLieAlongTheirAxis) {
  // Columns of black and white: along v nothing changes, along u all is mixed.
  Image columns(64, 64, {"R"});
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) columns.at(x, y, 0) = float(x / 8 % 2);
  }
  const CachedImage cached(columns);
  const Vec2 white{Float(12.0 / 64), Float(0.5)};
  const Float texel = Float(1.0 / 64);
  EXPECT_NEAR(value(cached, white, {{0, 16 * texel}, {texel, 0}}), 1, 1e-6);
  EXPECT_NEAR(value(cached, white, {{32 * texel, 0}, {0, 2 * texel}}), 0.5, 0.1);
}

TEST(TextureCache, FilesAreReadAsImagesAre) {
  const TemporaryFolder folder;
  const CacheLimit small(20);
  // More texels than are kept: levels 0 and 1 come from the file each time. Powers of two: levels made one
  // after the other are those made from the finest.
  const Image image = random_image(1024, 1024, 3);
  write_png(folder / "t.png", image);
  write_exr(folder / "t.exr", image, {});
  for (const char* name : {"t.png", "t.exr"}) {
    const CachedImage file(folder / name, {"R", "G", "B"}, TexelCoding::kColour);
    const CachedImage memory(read_image(folder / name));
    test::TestRandom random(9);
    for (int i = 0; i < 400; ++i) {
      const Vec2 uv{Float(random.uniform()), Float(random.uniform())};
      const Footprint over =
          i % 4 == 0 ? kPointFootprint : round_footprint(Float(std::pow(0.5, 10 * random.uniform())));
      for (std::size_t c = 0; c < 3; ++c) {
        EXPECT_NEAR(value(file, uv, over, c), value(memory, uv, over, c), 1e-6);
      }
    }
  }
}

TEST(TextureCache, DataIsTakenAsStored) {
  const TemporaryFolder folder;
  Image grey(1, 1, {"R", "G", "B"});
  grey.data = {0.25F, 0.25F, 0.25F};
  write_png(folder / "grey.png", grey);  // 137 of 255 in sRGB
  EXPECT_NEAR(value({folder / "grey.png", {"R"}, TexelCoding::kColour}, {}, {}), 0.25, 2e-3);
  EXPECT_NEAR(value({folder / "grey.png", {"R"}, TexelCoding::kData}, {}, {}), 137.0 / 255, 1e-6);
}

TEST(TextureCache, FilesWithLevelsAndTilesAreTakenAsTheyAre) {
  const char* const maketx = "/usr/bin/maketx";
  if (!std::filesystem::exists(maketx)) GTEST_SKIP() << "no " << maketx << " (openimageio-tools)";
  const TemporaryFolder folder;
  for (const auto& [name, width, height] :
       {std::tuple("t.tx", 256, 128), std::tuple("t.tx", 300, 200), std::tuple("tiled.exr", 256, 128)}) {
    const Image image = random_image(width, height, 3);
    write_exr(folder / "t.exr", image, {});
    const test::ProgramResult made = test::run_program(
        maketx, {"-d", "float", (folder / "t.exr").string(), "-o", (folder / name).string()});
    ASSERT_EQ(made.exit_code, 0) << made.errors;
    const CachedImage tiled(folder / name, {"R", "G", "B"}, TexelCoding::kColour), plain(image);
    test::TestRandom random(4);
    for (int i = 0; i < 400; ++i) {
      const Vec2 uv{Float(random.uniform()), Float(random.uniform())};
      EXPECT_EQ(value(tiled, uv, {}, 2), value(plain, uv, {}, 2));
      if (width != 256) continue;  // maketx halves odd sizes in a way of its own
      EXPECT_NEAR(value(tiled, uv, round_footprint(Float(0.1)), 1),
                  value(plain, uv, round_footprint(Float(0.1)), 1), 1e-6);
    }
  }
}

TEST(TextureCache, NoLookupDependsOnItsSizeOrOnThreads) {
  const TemporaryFolder folder;
  Image image(2047, 1023, {"R", "G", "B"});  // 24 MiB of floats, and a third of that of coarser levels
  for (std::size_t i = 0; i < image.data.size(); ++i) image.data[i] = float(i * 2654435761U % 1000) / 1000;
  write_exr(folder / "large.exr", image, {});
  constexpr std::size_t kLookups = 4000;
  const auto lookups = [&](int threads) {
    const CachedImage cached(folder / "large.exr", {"R", "G", "B"}, TexelCoding::kColour);
    std::vector<float> values(kLookups);
    std::size_t most_bytes = 0;
    std::vector<std::thread> all;
    for (int t = 0; t < threads; ++t) {
      all.emplace_back([&, t] {
        for (std::size_t i = std::size_t(t); i < kLookups; i += std::size_t(threads)) {
          test::TestRandom random(i);
          const Float size = Float(std::pow(0.5, 12 * random.uniform()));
          const Vec2 uv{Float(random.uniform()), (Float(i) + Float(random.uniform())) / kLookups};
          values[i] = value(cached, uv, {{3 * size, size}, {-size, size}}, i % 3);
          if (t == 0) most_bytes = std::max(most_bytes, texture_cache_bytes());
        }
      });
    }
    for (std::thread& thread : all) thread.join();
    return std::pair(values, most_bytes);
  };
  const auto [expected, all_bytes] = lookups(1);
  EXPECT_GT(all_bytes, std::size_t(24) << 20) << "the limit would not be felt";
  constexpr std::size_t kLimit = 10;   // MiB, the least the library takes
  const CacheLimit small(2 * kLimit);  // tiles have half of it; too little to keep the image whole
  for (const int threads : {1, 2, 7}) {
    const auto [values, bytes] = lookups(threads);
    EXPECT_EQ(values, expected) << threads << " threads";
    // Each thread may be reading a row of tiles, 64 · 2048 · 3 floats, and a tile of each level.
    EXPECT_LT(bytes, (kLimit + 2 * std::size_t(threads)) << 20);
  }
}

TEST(TextureCache, DamageIsToldWithTheFile) {
  const TemporaryFolder folder;
  const CacheLimit small(20);  // too little to keep the image whole
  const std::filesystem::path file = folder / "t.exr";
  const auto expect_told = [&](const auto& read, const std::string& problem) {
    try {
      read();
      ADD_FAILURE() << problem;
    } catch (const InputError& e) {
      EXPECT_EQ(e.diagnostics()[0].file, file.string());
      EXPECT_NE(e.diagnostics()[0].problem.find(problem), std::string::npos) << e.diagnostics()[0].problem;
    }
  };
  const auto load = [&] { return CachedImage(file, {"R", "G", "B"}, TexelCoding::kColour); };
  expect_told(load, "cannot be read");
  write_text(file, "no image");
  expect_told(load, "cannot be read");
  write_exr(file, random_image(1200, 1000, 3), {});
  expect_told([&] { return CachedImage(file, {"T"}, TexelCoding::kData); }, "has no channel \"T\"");
  const std::string sound = test::read_text(file);
  std::string hostile = sound;
  const std::string name("compression\0compression\0", 24);
  hostile.replace(hostile.find(name) + name.size(), 4, "\xff\xff\xff\x7f");
  write_text(file, hostile);
  expect_told(load, "announces 2147483647 bytes");
  write_text(file, sound);
  const CachedImage image = load();
  std::filesystem::resize_file(file, std::filesystem::file_size(file) / 2);
  expect_told(load, "damaged image");
  expect_told([&] { return value(image, {Float(0.5), Float(0.01)}, {}); }, "damaged image");
}

}  // namespace
}  // namespace spectrace
