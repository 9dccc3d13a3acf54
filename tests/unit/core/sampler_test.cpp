// SPDX-License-Identifier: Apache-2.0
#include "core/math/sampler.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <vector>

#include "core/spectra/sampled_spectrum.h"
#include "tests/support/chi_square.h"

namespace spectrace {
namespace {

using Pair = std::function<Vec2(std::uint64_t)>;

/// All trials of this file together have significance 0.01. Numbers are fixed, so a pass is a pass for ever.
constexpr std::size_t kTrials = 128;  // at most

/// Of `n` pairs over a 16 x 16 grid: catches uneven margins and any correlation coarser than 1/16.
double chi_square_of(int n, const Pair& pair) {
  std::vector<double> counts(256);
  for (int i = 0; i < n; ++i) {
    const Vec2 u = pair(static_cast<std::uint64_t>(i));
    counts[std::size_t(u.x * 16) * 16 + std::size_t(u.y * 16)] += 1;
  }
  double sum = 0;
  for (const double c : counts) sum += (c - n / 256.0) * (c - n / 256.0) / (n / 256.0);
  return sum;
}
void expect_independent(const char* what, const Pair& pair) {
  EXPECT_GT(test::chi_square_p_value(chi_square_of(1 << 17, pair), 255), test::sidak_level(0.01, kTrials))
      << what;
}

constexpr int kPathNumbers = 5, kVertexNumbers = 7;

std::array<Float, kPathNumbers> of_path(const Sampler& sampler) {
  const PathNumbers n = sampler.path();
  return {n.wavelength, n.pixel.x, n.pixel.y, n.lens.x, n.lens.y};
}
std::array<Float, kVertexNumbers> of_vertex(const Sampler& sampler, std::uint32_t vertex) {
  const VertexNumbers n = sampler.vertex(vertex);
  return {n.light_choice, n.light.x, n.light.y, n.lobe, n.bsdf.x, n.bsdf.y, n.roulette};
}
Float bsdf_x(std::uint64_t pixel, std::uint64_t sample, std::uint64_t seed, std::uint32_t vertex = 0) {
  return Sampler(pixel, sample, seed).vertex(vertex).bsdf.x;
}

TEST(Sampler, IsAFunctionOfItsArgumentsAlone) {
  const Sampler a(77, 5, 1);
  const auto first = of_vertex(a, 3);
  (void)a.path();
  (void)a.vertex(9);
  EXPECT_EQ(first, of_vertex(a, 3));
  EXPECT_EQ(first, of_vertex(Sampler(77, 5, 1), 3));
}

TEST(Sampler, NumbersStayWhatTheyWere) {
  // A change here changes every image ever rendered: say so in the changelog.
  const Sampler s(123456, 789, 42);
  EXPECT_NEAR(s.path().wavelength, 0.4485992193, 1e-7);
  EXPECT_NEAR(s.path().pixel.x, 0.8374225497, 1e-7);
  EXPECT_NEAR(s.vertex(0).light.y, 0.0422688723, 1e-7);
  EXPECT_NEAR(s.vertex(2).roulette, 0.6247736812, 1e-7);
}

TEST(Sampler, NumbersLieInTheHalfOpenUnitInterval) {
  for (std::uint64_t i = 0; i < 100000; ++i) {
    const Sampler s(i, i * i, ~i);
    for (const Float u : of_path(s)) ASSERT_TRUE(u >= 0 && u < 1);
    for (const Float u : of_vertex(s, i % 5)) ASSERT_TRUE(u >= 0 && u < 1);
  }
}

TEST(Sampler, NumbersOfOneVertexAreIndependentOverPixels) {
  for (const std::uint32_t vertex : {0U, 1U, 4U}) {
    for (std::size_t d = 0; d + 1 < kVertexNumbers; ++d) {
      expect_independent("neighbouring numbers", [=](std::uint64_t i) -> Vec2 {
        const auto u = of_vertex(Sampler(i, 5, 0), vertex);
        return {u[d], u[d + 1]};
      });
    }
  }
}

TEST(Sampler, NeighboursAreIndependent) {
  expect_independent("vertices", [](std::uint64_t i) -> Vec2 {
    return {bsdf_x(i, 0, 0, 0), bsdf_x(i, 0, 0, 1)};
  });
  expect_independent("pixels", [](std::uint64_t i) -> Vec2 {
    return {bsdf_x(i, 0, 0), bsdf_x(i + 1, 0, 0)};
  });
  expect_independent("rows", [](std::uint64_t i) -> Vec2 {
    return {bsdf_x(i, 0, 0), bsdf_x(i + 1024, 0, 0)};
  });
  // Neighbours within a block of samples are stratified; those a block apart know nothing of each other.
  expect_independent("blocks of samples", [](std::uint64_t i) -> Vec2 {
    return {bsdf_x(i, 3, 0), bsdf_x(i, 3 + (std::uint64_t(1) << 32), 0)};
  });
  expect_independent("seeds", [](std::uint64_t i) -> Vec2 { return {bsdf_x(9, 0, i), bsdf_x(9, 0, i + 1)}; });
  expect_independent("pixel and seed exchanged", [](std::uint64_t i) -> Vec2 {
    return {bsdf_x(i, 0, i + 1), bsdf_x(i + 1, 0, i)};
  });
  expect_independent("pixel and sample exchanged", [](std::uint64_t i) -> Vec2 {
    return {bsdf_x(i, 7, 0), bsdf_x(7, i, 0)};
  });
}

TEST(Sampler, NumbersOfAPathAreIndependentOverPixels) {
  expect_independent("pixel", [](std::uint64_t i) { return Sampler(i, 3, 0).path().pixel; });
  expect_independent("lens", [](std::uint64_t i) { return Sampler(i, 3, 0).path().lens; });
  expect_independent("wavelength, neighbouring pixels", [](std::uint64_t i) -> Vec2 {
    return {Sampler(i, 3, 0).path().wavelength, Sampler(i + 1, 3, 0).path().wavelength};
  });
  expect_independent("wavelength and the first bounce", [](std::uint64_t i) -> Vec2 {
    return {Sampler(i, 3, 0).path().wavelength, bsdf_x(i, 3, 0)};
  });
}

/// How many strata of width 1/n the first n samples of a pixel fall into.
template <typename Number>
std::size_t strata_hit(int n, std::uint64_t first, const Number& number) {
  std::set<int> strata;
  for (int i = 0; i < n; ++i) strata.insert(int(number(first + std::uint64_t(i)) * Float(n)));
  return strata.size();
}

TEST(Sampler, EveryNumberIsStratifiedOverEachAlignedBlock) {
  for (const std::uint64_t first : {0U, 256U, 4096U}) {
    for (std::size_t d = 1; d < kPathNumbers; ++d) {  // the wavelength has a test of its own
      EXPECT_EQ(strata_hit(256, first, [=](std::uint64_t i) { return of_path(Sampler(11, i, 0))[d]; }), 256U);
    }
    for (const std::uint32_t vertex : {0U, 1U, 2U, 7U}) {
      for (std::size_t d = 0; d < kVertexNumbers; ++d) {
        EXPECT_EQ(
            strata_hit(256, first, [=](std::uint64_t i) { return of_vertex(Sampler(11, i, 0), vertex)[d]; }),
            256U);
      }
    }
  }
}

TEST(Sampler, WavelengthsOfOnePixelAreStratified) {
  // Of all lanes together over kLanes^k samples, and of the heroes over kLanes^k times as many.
  const int n = kLanes * kLanes;
  std::set<int> lanes, heroes;
  for (int i = 0; i < n; ++i) {
    const Float u = Sampler(5, static_cast<std::uint64_t>(i), 1).path().wavelength;
    heroes.insert(int(u * Float(kLanes)));
    const Float set = u * Float(kLanes) - std::floor(u * Float(kLanes));
    lanes.insert(int(set * Float(n)));
  }
  EXPECT_EQ(lanes.size(), std::size_t(n)) << "sets of lanes";
  EXPECT_EQ(heroes.size(), std::size_t(kLanes));
}

TEST(Sampler, EveryElementaryBoxOfAPixelHasOneSample) {
  for (const std::uint64_t first : {0U, 64U, 4096U}) {  // any aligned block of samples
    for (int columns_log2 = 0; columns_log2 <= 6; ++columns_log2) {
      const int columns = 1 << columns_log2, rows = 64 / columns;
      std::set<int> boxes;
      for (std::uint64_t i = first; i < first + 64; ++i) {
        const Vec2 u = Sampler(3, i, 7).path().pixel;
        boxes.insert(int(u.x * Float(columns)) * rows + int(u.y * Float(rows)));
      }
      EXPECT_EQ(boxes.size(), 64U) << columns << " columns, from sample " << first;
    }
  }
}

/// Variance of counts over 4^k boxes of n samples of a pixel, over that of independent samples (1).
template <typename Numbers>
double unevenness(int n, const Numbers& numbers) {
  double sum = 0;
  int pixels = 0;
  for (std::uint64_t pixel = 0; pixel < 64; ++pixel, ++pixels) {
    std::map<std::size_t, double> counts;
    std::size_t boxes = 1;
    for (int i = 0; i < n; ++i) {
      std::size_t box = 0;
      boxes = 1;
      for (const Float u : numbers(Sampler(pixel, std::uint64_t(i), 3))) {
        box = box * 4 + std::size_t(u * 4);
        boxes *= 4;
      }
      counts[box] += 1;
    }
    const double expected = double(n) / double(boxes);
    double squares = (double(boxes) - double(counts.size())) * expected * expected;
    for (const auto& [box, count] : counts) squares += (count - expected) * (count - expected);
    sum += squares / (n * (1 - 1 / double(boxes)));
  }
  return sum / pixels;
}

Sampler independent(std::uint64_t pixel, std::uint64_t sample) {
  return {pixel, sample, 3, SamplerKind::kIndependent};
}

TEST(Sampler, IndependentSamplesKnowNothingOfEachOther) {
  for (std::size_t d = 0; d < kVertexNumbers; ++d) {
    for (const std::uint32_t vertex : {0U, 1U, 4U}) {
      expect_independent("samples of one pixel", [=](std::uint64_t i) -> Vec2 {
        return {of_vertex(independent(9, i), vertex)[d], of_vertex(independent(9, i + 1), vertex)[d]};
      });
    }
  }
  for (std::size_t d = 0; d + 1 < kPathNumbers; ++d) {
    expect_independent("numbers of one sample", [=](std::uint64_t i) -> Vec2 {
      const auto u = of_path(independent(9, i));
      return {u[d], u[d + 1]};
    });
  }
  expect_independent("vertices of one sample", [](std::uint64_t i) -> Vec2 {
    return {independent(9, i).vertex(0).bsdf.x, independent(9, i).vertex(1).bsdf.x};
  });
}

TEST(Sampler, IndependentSamplesAreNotStratified) {
  // 1 within five standard errors of 64 pixels' chi-squares of 63 degrees of freedom; a stratified one has 0.
  const double deviation = std::sqrt(2.0 / 63 / 64);
  for (const int n : {64, 256}) {
    double sum = 0;
    for (std::uint64_t pixel = 0; pixel < 64; ++pixel) {
      std::array<double, 64> counts{};
      for (int i = 0; i < n; ++i) {
        const Vec2 u = independent(pixel, std::uint64_t(i)).vertex(1).light;
        counts[std::size_t(u.x * 8) * 8 + std::size_t(u.y * 8)] += 1;
      }
      for (const double c : counts) sum += (c - n / 64.0) * (c - n / 64.0) / (n / 64.0);
    }
    EXPECT_NEAR(sum / 64 / 63, 1, 5 * deviation) << n << " samples";
  }
}

TEST(Sampler, NumbersThatMeetAreEvenTogether) {
  // Each of the 4 x 4 x 4 boxes has its 4 of 256 samples. Independent numbers have 1 here, and Sobol'
  // dimensions that do not suit each other more: 5, 4 and 6 had 4 for the first three.
  const auto light = [](const Sampler& s) {
    const VertexNumbers n = s.vertex(0);
    return std::array{n.light_choice, n.light.x, n.light.y};
  };
  const auto bounce = [](const Sampler& s) {
    return std::array{s.vertex(0).bsdf.x, s.vertex(0).bsdf.y, s.vertex(1).light.x};
  };
  const auto path = [](const Sampler& s) {
    return std::array{s.path().pixel.x, s.path().wavelength, s.vertex(0).light.x};
  };
  EXPECT_EQ(unevenness(256, light), 0);
  EXPECT_EQ(unevenness(256, bounce), 0);
  EXPECT_EQ(unevenness(256, path), 0);
}

}  // namespace
}  // namespace spectrace
