// SPDX-License-Identifier: Apache-2.0
// H6: the ends of the unit interval through every warp of the renderer. Those of the BSDFs are
// EveryBsdfContract's, those of tables Warp2D's.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "core/math/concentric_disk.h"
#include "core/math/math.h"
#include "core/spectra/sampled_wavelengths.h"
#include "renderer/lights.h"

namespace spectrace {
namespace {

constexpr std::array kEnds{
    Float(0), std::numeric_limits<Float>::denorm_min(), Float(1e-7), Float(0.5), kOneMinusEpsilon, Float(1)};

template <typename Visit>
void for_each_pair_of_ends(const Visit& visit) {
  for (const Float x : kEnds) {
    for (const Float y : kEnds) {
      SCOPED_TRACE(testing::Message() << "u = " << x << ", " << y);
      visit(Vec2{x, y});
    }
  }
}

TEST(H06_EndsOfTheUnitInterval, DiskStaysInTheDisk) {
  for_each_pair_of_ends([](Vec2 u) {
    const Vec2 p = concentric_disk(u);
    // A cosine and a sine of single precision, squared and added.
    EXPECT_LE(double(p.x) * double(p.x) + double(p.y) * double(p.y),
              1 + 4 * double(std::numeric_limits<Float>::epsilon()));
  });
}

TEST(H06_EndsOfTheUnitInterval, AreaLightsGivePointsInFrontOrNone) {
  // Beside them, far from them, all but touching them, and in their plane.
  const std::array<LightShape, 4> shapes{Sphere{{0, 0, 3}, 1}, Quad{{-1, -1, 3}, {0, 2, 0}, {2, 0, 0}},
                                         TriangleLight{{-1, -1, 3}, {0, 2, 0}, {2, 0, 0}},
                                         Disk{{0, 0, 3}, {0, 1, 0}, {1, 0, 0}}};
  const std::array<Vec3, 6> places{Vec3{0, 0, 0},     Vec3{-1, -1, Float(2.999)},
                                   Vec3{0, 0, -1e6F}, Vec3{5, 0, Float(2.9)},
                                   Vec3{5, 0, 3},     Vec3{0, 0, Float(1.999999)}};
  for (const LightShape& shape : shapes) {
    for (const Vec3 from : places) {
      SCOPED_TRACE(testing::Message() << "shape " << shape.index() << ", from " << from.x << ' ' << from.z);
      for_each_pair_of_ends([&](Vec2 u) {
        const auto point = sample_light(shape, from, u);
        if (!point) return;
        EXPECT_TRUE(is_finite(point->position));
        EXPECT_NEAR(length(point->wi), 1, 1e-5);
        EXPECT_TRUE(point->pdf > 0 && std::isfinite(point->pdf)) << point->pdf;
      });
    }
  }
}

TEST(H06_EndsOfTheUnitInterval, SkiesGiveDirectionsOfTheirDensity) {
  Image image(8, 4, {"R", "G", "B"});  // black but for two texels, at the image's corners
  for (std::size_t c = 0; c < 3; ++c) {
    image.at(0, 0, c) = 5;
    image.at(7, 3, c) = 100;
  }
  const Environment sky(image, "sky", Spectrum::constant(1), {});
  for_each_pair_of_ends([&](Vec2 u) {
    const auto s = sky.sample(u);
    if (!s) return;  // the very pole
    EXPECT_NEAR(length(s->wi), 1, 1e-5);
    EXPECT_TRUE(s->pdf > 0 && std::isfinite(s->pdf)) << s->pdf;
  });
  // The whole weight in one cell, first or last: no number leads to another.
  for (const std::size_t lit : {std::size_t(0), std::size_t(5)}) {
    std::vector<double> weights(6, 0);
    weights[lit] = 1e30;
    const GridDensity density(3, 2, weights);
    for_each_pair_of_ends([&](Vec2 u) {
      const GridDensity::Sample s = density.sample(u);
      EXPECT_GT(s.pdf, 0);
      EXPECT_TRUE(s.position.x >= 0 && s.position.x <= 1 && s.position.y >= 0 && s.position.y <= 1);
    });
  }
}

TEST(H06_EndsOfTheUnitInterval, WavelengthsLieInTheRangeWithADensity) {
  const WavelengthRange range{300, 1100};
  for (const auto& distribution :
       {WavelengthDistribution::uniform(range), WavelengthDistribution::visible(range),
        WavelengthDistribution::at_centers(range, 195), WavelengthDistribution::at_centers(range, 1)}) {
    for (const Float u : kEnds) {
      const SampledWavelengths lambda = distribution.sample(std::min(u, kOneMinusEpsilon));
      for (int lane = 0; lane < kLanes; ++lane) {
        EXPECT_GE(lambda.lambda_nm(lane), range.min_nm) << u;
        EXPECT_LE(lambda.lambda_nm(lane), range.max_nm) << u;
        EXPECT_TRUE(lambda.pdf_per_nm(lane) > 0 && std::isfinite(lambda.pdf_per_nm(lane))) << u;
      }
    }
  }
}

TEST(H06_EndsOfTheUnitInterval, TheChoiceOfALightHasAProbability) {
  std::vector<Lights::AreaLight> area;
  for (int i = 0; i < 40; ++i) area.push_back({Sphere{{Float(3 * i), 0, 9}, 1}, std::uint32_t(i % 2)});
  const Lights lights(
      area, std::vector<std::uint32_t>(area.size(), 1),
      {Spectrum::constant(Float(1e10)), Spectrum::constant(Float(1e-10))},
      {PointLight{{0, 0, 5}, Spectrum::constant(1)}, DirectionalLight{{0, 0, 1}, Spectrum::constant(1)}},
      std::nullopt, WavelengthDistribution::uniform({}), 100);
  for (const Float x : {Float(0), Float(117), Float(-1e5)}) {
    const Receiver receiver{{x, 0, 0}, {0, 0, 1}};
    for (const Float u : kEnds) {
      const auto choice = lights.choose(receiver, std::min(u, kOneMinusEpsilon));
      ASSERT_TRUE(choice) << x << ' ' << u;
      EXPECT_GT(choice->probability, 0) << x << ' ' << u;
      EXPECT_EQ(choice->probability, lights.probability(choice->light, receiver)) << x << ' ' << u;
    }
  }
}

}  // namespace
}  // namespace spectrace
