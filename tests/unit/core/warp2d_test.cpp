// SPDX-License-Identifier: Apache-2.0
#include "core/math/warp2d.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <random>
#include <vector>

#include "core/base/error.h"
#include "tests/support/chi_square.h"

namespace spectrace {
namespace {

constexpr Float kEpsilon = std::numeric_limits<Float>::epsilon();
/// u -> position -> u runs in double through cumulative sums near 1: each of the two ways rounds about ten
/// times.
constexpr double kRoundTripTolerance = 40 * std::numeric_limits<double>::epsilon();

/// Values over five decades with cells, rows and columns of zeros: what measured distributions look like.
std::vector<Float> rough_grid(int slices, int width, int height, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<Float> data;
  for (int s = 0; s < slices; ++s) {
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const bool zero = y < 2 || x == width - 1 || (y > 4 && y < 8) || uniform(random) < 0.1;
        data.push_back(zero ? Float(0) : static_cast<Float>(std::pow(10, 5 * uniform(random) - 5)));
      }
    }
  }
  return data;
}

const std::vector<Float> kP0{Float(-1), Float(0.5), Float(2)};
const std::vector<Float> kP1{Float(0), Float(0.25), Float(1), Float(1.5)};

Warp2D rough_warp(bool normalize = true) {
  return Warp2D(kP0, kP1, 16, 12, rough_grid(12, 16, 12, 7), normalize);
}

/// Between parameter nodes, on them, and outside their range.
const std::vector<WarpParams> kParams{{Float(-1), Float(0)},     {Float(0.1), Float(0.9)},
                                      {Float(0.5), Float(0.25)}, {Float(1.99), Float(1.499)},
                                      {Float(2), Float(1.5)},    {Float(-9), Float(9)}};

TEST(Warp2D, NormalizedDensityIntegratesToOne) {
  const Warp2D warp = rough_warp();
  for (const WarpParams p : kParams) {
    // Two-point Gauss rules integrate each bilinear cell exactly.
    double sum = 0;
    const double g = 0.5 / std::sqrt(3.0);
    for (int y = 0; y < 11; ++y) {
      for (int x = 0; x < 15; ++x) {
        for (const double dy : {-g, g}) {
          for (const double dx : {-g, g}) {
            sum += warp.eval({Float((x + 0.5 + dx) / 15), Float((y + 0.5 + dy) / 11)}, p);
          }
        }
      }
    }
    EXPECT_NEAR(sum / (4 * 11 * 15), 1, 50 * kEpsilon);
  }
}

TEST(Warp2D, EvalIsBilinearInPositionAndLinearInParameters) {
  const std::vector<Float> data{0, 1, 2, 4, /* p0 = 10 */ 10, 10, 10, 20 /* p0 = 20 */};
  const std::vector<Float> p0{10, 20}, p1{0};
  const Warp2D warp(p0, p1, 2, 2, data, false);
  EXPECT_FLOAT_EQ(warp.eval({0, 0}, {10, 0}), 0);
  EXPECT_FLOAT_EQ(warp.eval({1, 0}, {10, 0}), 1);
  EXPECT_FLOAT_EQ(warp.eval({0, 1}, {10, 0}), 2);
  EXPECT_FLOAT_EQ(warp.eval({1, 1}, {10, 0}), 4);
  EXPECT_FLOAT_EQ(warp.eval({0.5, 0.5}, {10, 0}), 1.75);
  EXPECT_FLOAT_EQ(warp.eval({1, 1}, {15, 0}), 12);
  EXPECT_FLOAT_EQ(warp.eval({1, 1}, {Float(12.5), 3}), 8);
  EXPECT_FLOAT_EQ(warp.eval({1, 1}, {0, 0}), 4) << "the end value holds below the range";
  EXPECT_FLOAT_EQ(warp.eval({1, 1}, {99, 0}), 20) << "the end value holds above the range";
}

TEST(Warp2D, SlicesAreOrderedFirstParameterFirst) {
  // value = 100 p0 + 10 p1 in node units, constant over the square
  std::vector<Float> data;
  for (int a = 0; a < 3; ++a) {
    for (int b = 0; b < 4; ++b) data.insert(data.end(), 4, Float(100 * a + 10 * b));
  }
  const Warp2D warp(kP0, kP1, 2, 2, data, false);
  EXPECT_FLOAT_EQ(warp.eval({0.3f, 0.6f}, {2, 0}), 200);
  EXPECT_FLOAT_EQ(warp.eval({0.3f, 0.6f}, {Float(0.5), Float(1.5)}), 130);
  EXPECT_FLOAT_EQ(warp.eval({0.3f, 0.6f}, {Float(1.25), Float(1.25)}), 175);
}

TEST(Warp2D, UnnormalizedKeepsItsValues) {
  const std::vector<Float> data = rough_grid(12, 16, 12, 7);
  EXPECT_FLOAT_EQ(rough_warp(false).eval({3.0 / 15, 3.0 / 11}, {kP0[0], kP1[0]}), data[3 * 16 + 3]);
}

TEST(Warp2D, InvertUndoesSample) {
  const Warp2D warp = rough_warp();
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (const WarpParams p : kParams) {
    for (int i = 0; i < 20000; ++i) {
      const UnitPoint u{uniform(random), uniform(random)};
      const Warp2D::Sample s = warp.sample(u, p);
      const Warp2D::Sample back = warp.invert(s.position, p);
      ASSERT_NEAR(back.position.y, u.y, kRoundTripTolerance);
      // Next to rows of tiny mass a rounded y moves the conditional by the ratio of the masses, here up to
      // 1e5.
      ASSERT_NEAR(back.position.x, u.x, 1e5 * kRoundTripTolerance);
      ASSERT_FLOAT_EQ(back.pdf, s.pdf);
      ASSERT_EQ(warp.eval(s.position, p), s.pdf);
    }
  }
}

TEST(Warp2D, SampleIsDistributedAsItsDensity) {
  // Chi-square over the cells, each cell's mass by exact bilinear integration; significance 0.01 in all.
  const Warp2D warp = rough_warp();
  const int n = 200000;
  for (const WarpParams p : kParams) {
    std::vector<double> observed(11 * 15), expected(11 * 15);
    std::mt19937 random(11);
    std::uniform_real_distribution<double> uniform(0, 1);
    for (int i = 0; i < n; ++i) {
      const Vec2 at = warp.sample({Float(uniform(random)), Float(uniform(random))}, p).position;
      const int x = std::min(14, int(at.x * 15)), y = std::min(10, int(at.y * 11));
      observed[std::size_t(y * 15 + x)] += 1;
    }
    for (int y = 0; y < 11; ++y) {
      for (int x = 0; x < 15; ++x) {
        double sum = 0;
        for (int c = 0; c < 4; ++c) sum += warp.eval({Float(x + c % 2) / 15, Float(y + c / 2) / 11}, p);
        expected[std::size_t(y * 15 + x)] = n * sum / 4 / (11 * 15);
      }
    }
    double statistic = 0, pooled_observed = 0, pooled_expected = 0;
    int freedom = -1;
    for (std::size_t i = 0; i < observed.size(); ++i) {
      if (expected[i] == 0) {
        ASSERT_EQ(observed[i], 0) << "a sample in a cell without mass";
      } else if (expected[i] < 10) {
        pooled_observed += observed[i];
        pooled_expected += expected[i];
      } else {
        statistic += std::pow(observed[i] - expected[i], 2) / expected[i];
        ++freedom;
      }
    }
    if (pooled_expected > 0) {
      statistic += std::pow(pooled_observed - pooled_expected, 2) / std::max(pooled_expected, 10.0);
      ++freedom;
    }
    EXPECT_GT(test::chi_square_p_value(statistic, freedom), test::sidak_level(0.01, kParams.size()));
  }
}

TEST(Warp2D, EndsOfTheUnitIntervalGiveValidPositions) {  // hard case H6
  const std::vector<Float> ends{
      0, std::numeric_limits<Float>::denorm_min(), kEpsilon, Float(0.5), kOneMinusEpsilon, 1};
  const Warp2D warp = rough_warp();
  for (const WarpParams p : kParams) {
    for (const Float uy : ends) {
      for (const Float ux : ends) {
        const Warp2D::Sample s = warp.sample({ux, uy}, p);
        EXPECT_TRUE(s.position.x >= 0 && s.position.x <= 1 && s.position.y >= 0 && s.position.y <= 1);
        EXPECT_TRUE(std::isfinite(s.pdf) && s.pdf >= 0);
        const Warp2D::Sample back = warp.invert({ux, uy}, p);
        EXPECT_TRUE(back.position.x >= 0 && back.position.x <= 1 && back.position.y >= 0 &&
                    back.position.y <= 1);
        EXPECT_TRUE(std::isfinite(back.pdf) && back.pdf >= 0);
      }
    }
  }
}

TEST(Warp2D, NothingIsDrawnFromCellsWithoutMass) {
  // Mass only in the middle of five columns and rows: u at either end must stay in its support [1/4, 3/4].
  std::vector<Float> data(25, 0);
  data[12] = 1;
  const std::vector<Float> one{0};
  const Warp2D warp(one, one, 5, 5, data, true);
  for (const Float uy : {Float(0), Float(0.3), kOneMinusEpsilon, Float(1)}) {
    for (const Float ux : {Float(0), Float(0.3), kOneMinusEpsilon, Float(1)}) {
      const Warp2D::Sample s = warp.sample({ux, uy});
      const Vec2 at = s.position;
      if (ux > 0 && uy > 0) {  // at 0 it starts on the border of the support, where the density is 0
        EXPECT_GT(s.pdf, 0);
      }
      EXPECT_GE(at.y, 0.25f);
      EXPECT_LE(at.y, 0.75f);
      if (uy == Float(0)) continue;  // on the border row itself the density is 0 and x has no meaning
      EXPECT_GE(at.x, 0.25f);
      EXPECT_LE(at.x, 0.75f);
    }
  }
}

TEST(Warp2D, SliceOfZerosIsUniform) {
  const std::vector<Float> data(6 * 4, 0), one{0};
  const Warp2D warp(one, one, 6, 4, data, true);
  const Warp2D::Sample s = warp.sample({0.375, 0.8125});
  EXPECT_NEAR(s.position.x, 0.375, kRoundTripTolerance);
  EXPECT_NEAR(s.position.y, 0.8125, kRoundTripTolerance);
  EXPECT_FLOAT_EQ(s.pdf, 1);
}

TEST(Warp2D, ExtremeScalesAreNormalized) {
  for (const Float scale : {std::numeric_limits<Float>::denorm_min(), std::numeric_limits<Float>::max()}) {
    const std::vector<Float> data(9, scale), one{0};
    EXPECT_FLOAT_EQ(Warp2D(one, one, 3, 3, data, true).eval({0.5f, 0.5f}), 1);
  }
}

TEST(Warp2D, NaNIsNoIndex) {
  const Float nan = std::numeric_limits<Float>::quiet_NaN();
  const Warp2D warp = rough_warp();
  EXPECT_TRUE(std::isfinite(warp.sample({nan, nan}, {nan, nan}).position.x));
  EXPECT_TRUE(std::isfinite(warp.eval({nan, nan}, {nan, nan})));
}

TEST(Warp2D, RejectsTablesThatAreNone) {
  const std::vector<Float> one{0}, equal{1, 1}, good{1, 1, 1, 1}, negative{1, 1, -1, 1};
  const std::vector<Float> nan{1, 1, std::numeric_limits<Float>::quiet_NaN(), 1};
  EXPECT_THROW(Warp2D(one, one, 2, 2, negative, true), InternalError);
  EXPECT_THROW(Warp2D(one, one, 2, 2, nan, true), InternalError);
  EXPECT_THROW(Warp2D(one, one, 2, 1, good, true), InternalError);
  EXPECT_THROW(Warp2D(one, one, 2, 3, good, true), InternalError);
  EXPECT_THROW(Warp2D(equal, one, 2, 1, good, true), InternalError);
  EXPECT_THROW(Warp2D({}, one, 2, 2, {}, true), InternalError);
}

}  // namespace
}  // namespace spectrace
