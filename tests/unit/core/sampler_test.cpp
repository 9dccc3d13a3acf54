// SPDX-License-Identifier: Apache-2.0
#include "core/math/sampler.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <set>
#include <vector>

#include "core/spectra/sampled_spectrum.h"
#include "tests/support/chi_square.h"

namespace spectrace {
namespace {

using Pair = std::function<Vec2(std::uint64_t)>;

/// All trials of this file together have significance 0.01. Numbers are fixed, so a pass is a pass for ever.
constexpr std::size_t kTrials = 64;  // at most

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

Float bsdf_x(std::uint64_t pixel, std::uint64_t sample, std::uint64_t seed, std::uint32_t vertex = 0) {
  return Sampler(pixel, sample, seed).get2d(vertex, VertexDimension::kBsdf).x;
}

TEST(Sampler, IsAFunctionOfItsArgumentsAlone) {
  const Sampler a(77, 5, 1);
  const Float first = a.get1d(3, VertexDimension::kLightChoice);
  (void)a.get1d(PathDimension::kWavelength);
  (void)a.get2d(9, VertexDimension::kBsdf);
  EXPECT_EQ(first, a.get1d(3, VertexDimension::kLightChoice));
  EXPECT_EQ(first, Sampler(77, 5, 1).get1d(3, VertexDimension::kLightChoice));
}

TEST(Sampler, NumbersStayWhatTheyWere) {
  // A change here changes every image ever rendered: say so in the changelog.
  const Sampler s(123456, 789, 42);
  EXPECT_NEAR(s.get1d(PathDimension::kWavelength), 0.4418148398, 1e-7);
  EXPECT_NEAR(s.get2d(PathDimension::kPixel).x, 0.7928214669, 1e-7);
  EXPECT_NEAR(s.get2d(PathDimension::kPixel).y, 0.3389383554, 1e-7);
  EXPECT_NEAR(s.get1d(2, VertexDimension::kRoulette), 0.3633237481, 1e-7);
}

TEST(Sampler, NumbersLieInTheHalfOpenUnitInterval) {
  for (std::uint64_t i = 0; i < 100000; ++i) {
    const Sampler s(i, i * i, ~i);
    for (const Float u : {s.get1d(PathDimension::kWavelength), s.get2d(PathDimension::kPixel).x,
                          s.get2d(PathDimension::kPixel).y, s.get1d(0, VertexDimension::kBsdfLobe)}) {
      ASSERT_GE(u, 0);
      ASSERT_LT(u, 1);
    }
  }
}

TEST(Sampler, DimensionsOfOneVertexAreIndependent) {
  for (std::uint32_t d = 0; d + 1 < static_cast<std::uint32_t>(VertexDimension::kEnd); ++d) {
    expect_independent("neighbouring dimensions", [d](std::uint64_t i) -> Vec2 {
      const Sampler s(i % 512, i / 512, 0);
      return {s.get1d(0, static_cast<VertexDimension>(d)), s.get1d(0, static_cast<VertexDimension>(d + 1))};
    });
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

TEST(Sampler, StratifiedDimensionsAreIndependentOverPixels) {
  const auto at = [](std::uint64_t i, PathDimension d) { return Sampler(i, 3, 0).get2d(d); };
  expect_independent("kPixel", [&](std::uint64_t i) { return at(i, PathDimension::kPixel); });
  expect_independent("kWavelength, neighbouring pixels", [](std::uint64_t i) -> Vec2 {
    return {Sampler(i, 3, 0).get1d(PathDimension::kWavelength),
            Sampler(i + 1, 3, 0).get1d(PathDimension::kWavelength)};
  });
  expect_independent("kWavelength and the first bounce", [](std::uint64_t i) -> Vec2 {
    const Sampler s(i % 64, i / 64, 0);
    return {s.get1d(PathDimension::kWavelength), s.get2d(0, VertexDimension::kBsdf).x};
  });
  expect_independent("kPixel and the first bounce", [](std::uint64_t i) -> Vec2 {
    const Sampler s(i % 64, i / 64, 0);
    return {s.get2d(PathDimension::kPixel).x, s.get2d(0, VertexDimension::kBsdf).x};
  });
}

TEST(Sampler, WavelengthsOfOnePixelAreStratified) {
  const double pixel_offset = Sampler(5, 0, 1).get1d(PathDimension::kWavelength);
  for (const int n : {kLanes * kLanes, kLanes * kLanes * kLanes * kLanes}) {
    for (const int width : {1, kLanes}) {  // the heroes, and all lanes
      std::set<int> strata;
      for (int i = 0; i < n / (width == 1 ? 1 : kLanes); ++i) {
        const double u = Sampler(5, static_cast<std::uint64_t>(i), 1).get1d(PathDimension::kWavelength);
        for (int lane = 0; lane < width; ++lane) {
          // 2^-22: both terms are rounded to 24 bits, and every fourth stratum begins just at a sample.
          const double t = u - pixel_offset + double(lane) / kLanes + 1 + 0x1p-22;
          strata.insert(int((t - std::floor(t)) * n));
        }
      }
      EXPECT_EQ(strata.size(), std::size_t(n)) << "one wavelength in each stratum; lanes counted: " << width;
    }
  }
}

TEST(Sampler, PixelPositionsFillThePixelEvenly) {
  // Points in boxes [0, a) x [0, b) against n a b. Random points of this number are off by 20 or more
  // (asserted); these, rotated by the pixel's offset, by about 5.
  const int n = 1024;
  double worst = 0, worst_random = 0;
  for (int a = 1; a < 32; ++a) {
    for (int b = 1; b < 32; ++b) {
      int inside = 0, random_inside = 0;
      for (int i = 0; i < n; ++i) {
        const Vec2 u = Sampler(8, static_cast<std::uint64_t>(i), 0).get2d(PathDimension::kPixel);
        inside += u.x < Float(a) / 32 && u.y < Float(b) / 32;
        // Another pixel each time: independent.
        const Vec2 v = Sampler(static_cast<std::uint64_t>(i), 0, 0).get2d(0, VertexDimension::kBsdf);
        random_inside += v.x < Float(a) / 32 && v.y < Float(b) / 32;
      }
      worst = std::max(worst, std::abs(inside - n * double(a) * b / 1024));
      worst_random = std::max(worst_random, std::abs(random_inside - n * double(a) * b / 1024));
    }
  }
  EXPECT_LT(worst, 8);
  EXPECT_GT(worst_random, 20);
}

TEST(Sampler, EveryElementaryBoxOfAPairHasOneSample) {
  for (const std::uint64_t first : {0U, 64U, 4096U}) {  // any aligned block of samples
    for (int columns_log2 = 0; columns_log2 <= 6; ++columns_log2) {
      const int columns = 1 << columns_log2, rows = 64 / columns;
      std::set<int> boxes;
      for (std::uint64_t i = first; i < first + 64; ++i) {
        const Vec2 u = Sampler(3, i, 7).get2d(2, VertexDimension::kLight);
        boxes.insert(int(u.x * Float(columns)) * rows + int(u.y * Float(rows)));
      }
      EXPECT_EQ(boxes.size(), 64U) << columns << " columns, from sample " << first;
    }
  }
}

TEST(Sampler, EverySingleNumberIsStratified) {
  for (const VertexDimension d : {VertexDimension::kLightChoice, VertexDimension::kBsdfLobe,
                                  VertexDimension::kRoulette, VertexDimension::kMask}) {
    std::set<int> strata;
    for (std::uint64_t i = 0; i < 256; ++i) strata.insert(int(Sampler(11, i, 0).get1d(1, d) * 256));
    EXPECT_EQ(strata.size(), 256U);
  }
}

TEST(Sampler, NumbersOfOneSampleAreIndependentOverTheSamplesOfAPixel) {
  // Padded sequences share their index: without an order of its own each would be a function of the other.
  expect_independent("light and BSDF", [](std::uint64_t i) -> Vec2 {
    const Sampler s(5, i, 0);
    return {s.get2d(0, VertexDimension::kLight).x, s.get2d(0, VertexDimension::kBsdf).x};
  });
  expect_independent("one number at two vertices", [](std::uint64_t i) -> Vec2 {
    const Sampler s(5, i, 0);
    return {s.get1d(0, VertexDimension::kBsdfLobe), s.get1d(1, VertexDimension::kBsdfLobe)};
  });
}

TEST(Sampler, WavelengthAndPixelPositionAreJointlyEven) {
  // An edge inside a pixel must not pick out wavelengths: counts over 8 x 8 x 8 boxes vary no more than
  // random ones would, whose chi-square is near its 511 degrees of freedom (seen: 230 to 390).
  const int n = 8192;
  for (const std::uint64_t pixel : {0u, 1u, 1000u}) {
    std::vector<double> counts(512);
    for (int i = 0; i < n; ++i) {
      const Sampler s(pixel, static_cast<std::uint64_t>(i), 0);
      const Vec2 p = s.get2d(PathDimension::kPixel);
      const auto box = std::size_t(p.x * 8) * 64 + std::size_t(p.y * 8) * 8 +
                       std::size_t(s.get1d(PathDimension::kWavelength) * 8);
      counts[box] += 1;
    }
    double sum = 0;
    for (const double c : counts) sum += (c - n / 512.0) * (c - n / 512.0) / (n / 512.0);
    EXPECT_LT(sum, 511);
  }
}

}  // namespace
}  // namespace spectrace
