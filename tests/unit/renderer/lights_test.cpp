// SPDX-License-Identifier: Apache-2.0
#include "renderer/lights.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/math/math.h"
#include "renderer/accel_embree.h"
#include "renderer/surface.h"

namespace spectrace {
namespace {

struct Hit {
  Vec3 position, normal;
};

std::optional<Hit> trace(const Sphere& s, const Ray& ray) {
  const auto crossings = intersect_sphere(s, ray);
  if (!crossings || !(crossings->near > 0)) return std::nullopt;
  const Vec3 p = ray.origin + ray.direction * Float(crossings->near);
  return Hit{p, normalize(p - s.center)};
}
std::optional<Hit> trace(const Quad& q, const Ray& ray) {
  const Vec3 n = normalize(q.scaled_normal());
  const Vec3 p = ray.origin + ray.direction * (dot(q.corner - ray.origin, n) / dot(ray.direction, n));
  return Hit{p, n};
}

std::optional<Hit> trace(const Disk& d, const Ray& ray) {
  const auto crossing = intersect_disk(d, ray);
  if (!crossing) return std::nullopt;
  return Hit{ray.origin + ray.direction * Float(crossing->t), normalize(d.scaled_normal())};
}

/// Samples a light from many places: densities agree with light_pdf(), and the mean of 1 / pdf is the solid
/// angle.
template <typename Shape>
double solid_angle(const Shape& shape, Vec3 from) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform;
  double sum = 0;
  constexpr int kSamples = 20000;
  for (int i = 0; i < kSamples; ++i) {
    const auto point = sample_light(shape, from, {Float(uniform(random)), Float(uniform(random))});
    if (!point) continue;
    EXPECT_NEAR(length(point->wi), 1, 1e-5);
    sum += 1 / double(point->pdf);
    if (const auto hit = trace(shape, Ray{from, point->wi})) {
      EXPECT_NEAR(light_pdf(shape, from, point->wi, hit->position, hit->normal) / point->pdf, 1, 2e-2);
    }
  }
  return sum / kSamples;
}

double cap(double radius, double distance) {
  const double s2 = radius * radius / (distance * distance);
  return 2 * kPi64 * s2 / (1 + std::sqrt(1 - s2));
}

TEST(SphereLight, SolidAngleIsThatOfItsConeNearAndFar) {
  for (double distance : {1.0001, 1.1, 3.0, 1e3, 1e6}) {
    const double expected = cap(1, distance);
    EXPECT_NEAR(solid_angle(Sphere{{0, 0, Float(distance)}, 1}, {0, 0, 0}) / expected, 1, 2e-3) << distance;
  }
}

TEST(SphereLight, IsNotSampledFromInside) {
  EXPECT_FALSE(sample_light(Sphere{{0, 0, 0}, 1}, {Float(0.5), 0, 0}, {Float(0.5), Float(0.5)}));
  EXPECT_EQ(light_pdf(Sphere{{0, 0, 0}, 1}, {Float(0.5), 0, 0}, {1, 0, 0}, {1, 0, 0}, {1, 0, 0}), 0);
}

TEST(SphereLight, EdgeNumbersGiveValidDirections) {
  for (Float a : {Float(0), kOneMinusEpsilon, Float(1)}) {
    for (Float b : {Float(0), kOneMinusEpsilon, Float(1)}) {
      const auto point = sample_light(Sphere{{0, 0, 3}, 1}, {0, 0, 0}, {a, b});
      ASSERT_TRUE(point);
      EXPECT_TRUE(is_finite(point->wi) && is_finite(point->position) && point->pdf > 0);
    }
  }
}

TEST(QuadLight, SolidAngleMatchesTheClosedForm) {
  // Square of side 2 at distance 1: 4 atan(1 / sqrt(3)) (a face of a cube seen from its centre: 4π/6).
  const Quad quad{{-1, -1, 1}, {0, 2, 0}, {2, 0, 0}};
  EXPECT_NEAR(solid_angle(quad, {0, 0, 0}), 4 * kPi64 / 6, 0.02);
}

TEST(QuadLight, ShowsNothingFromBehind) {
  const Quad quad{{-1, -1, 1}, {2, 0, 0}, {0, 2, 0}};
  EXPECT_FALSE(sample_light(quad, {0, 0, 0}, {Float(0.5), Float(0.5)}));
  Quad mirrored = quad;
  mirrored.mirrored = true;
  EXPECT_TRUE(sample_light(mirrored, {0, 0, 0}, {Float(0.5), Float(0.5)}));
}

TEST(DiskLight, SolidAngleMatchesTheClosedForm) {
  // Seen from above its centre: a cone of half angle atan(radius / distance).
  const Disk disk{{0, 0, 1}, {0, 2, 0}, {2, 0, 0}};
  EXPECT_NEAR(solid_angle(disk, {0, 0, 0}), 2 * kPi64 * (1 - 1 / std::sqrt(5)), 0.01);
  // An ellipse from far away: area · cosine / distance².
  const Disk ellipse{{0, 0, 1000}, {1, 3, 0}, {4, 0, 0}};
  EXPECT_NEAR(solid_angle(ellipse, {0, 0, 0}) / (kPi64 * 12 / 1e6), 1, 1e-4);
}

TEST(DiskLight, ShowsNothingFromBehind) {
  Disk disk{{0, 0, 1}, {2, 0, 0}, {0, 2, 0}};
  EXPECT_FALSE(sample_light(disk, {0, 0, 0}, {Float(0.3), Float(0.5)}));
  disk.mirrored = true;
  EXPECT_TRUE(sample_light(disk, {0, 0, 0}, {Float(0.3), Float(0.5)}));
}

TEST(DiskLight, PointsOfAnEllipseAreUniform) {
  const Disk ellipse{{0, 0, 1}, {1, 3, 0}, {4, 0, 0}};
  std::mt19937 random(8);
  std::uniform_real_distribution<double> uniform;
  double inner = 0, half = 0;
  constexpr int kSamples = 20000;
  for (int i = 0; i < kSamples; ++i) {
    const auto point = sample_light(ellipse, {0, 0, 0}, {Float(uniform(random)), Float(uniform(random))});
    ASSERT_TRUE(point);
    const auto at = intersect_disk(ellipse, Ray{{0, 0, 0}, point->wi});
    if (!at) continue;  // rounded past the rim
    inner += at->x * at->x + at->y * at->y < 0.25 ? 1 : 0;
    half += at->x > 0 ? 1 : 0;
  }
  // 4 standard errors of shares of 1/4 and 1/2.
  EXPECT_NEAR(inner / kSamples, 0.25, 4 * std::sqrt(0.25 * 0.75 / kSamples));
  EXPECT_NEAR(half / kSamples, 0.5, 4 * std::sqrt(0.25 / kSamples));
}

TEST(TriangleLight, PointsAreUniform) {
  const TriangleLight triangle{{-1, -1, 1}, {0, 2, 0}, {2, 0, 0}};
  std::mt19937 random(4);
  std::uniform_real_distribution<double> uniform;
  double x = 0, y = 0;
  constexpr int kSamples = 20000;
  for (int i = 0; i < kSamples; ++i) {
    const auto point = sample_light(triangle, {0, 0, 0}, {Float(uniform(random)), Float(uniform(random))});
    ASSERT_TRUE(point);
    x += point->position.x;
    y += point->position.y;
  }
  EXPECT_NEAR(x / kSamples, -1 / 3.0, 0.015);  // the centroid, to 4 standard errors
  EXPECT_NEAR(y / kSamples, -1 / 3.0, 0.015);
}

TEST(Lights, ChoiceFavoursPowerAndStarvesNone) {
  const WavelengthDistribution wavelengths = WavelengthDistribution::uniform({});
  std::vector<Lights::AreaLight> area{{Sphere{{0, 0, 0}, 1}, 0}, {Sphere{{0, 0, 9}, 1}, 1}};
  const Lights lights(area, {1, 1}, {Spectrum::constant(Float(1e10)), Spectrum::constant(Float(1e-10))},
                      {PointLight{{0, 0, 0}, Spectrum::constant(0)}}, std::nullopt, wavelengths, 10);
  // Of two lights the table, 0.75 and 0.25 by power, keeps half; the estimates see the first alone.
  const Receiver receiver{{0, 0, 5}, {}};
  EXPECT_NEAR(lights.probability(0, receiver), 0.875, 1e-6);
  EXPECT_NEAR(lights.probability(1, receiver), 0.125, 1e-6);
  EXPECT_EQ(lights.probability(2, receiver), 0);  // a lamp that is off
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform;
  int count[3] = {0, 0, 0};
  for (int i = 0; i < 20000; ++i) {
    const auto choice = lights.choose(receiver, std::min(Float(uniform(random)), kOneMinusEpsilon));
    ASSERT_TRUE(choice);
    EXPECT_EQ(choice->probability, lights.probability(choice->light, receiver));
    ++count[choice->light];
  }
  EXPECT_NEAR(count[0] / 20000.0, 0.875, 0.01);  // 4 standard errors
  EXPECT_EQ(count[2], 0);
}

double drop_at(double angle_deg) { return 1 - std::cos(angle_deg * kPi64 / 180); }
SpotLight spot_light(double full_deg, double dark_deg) {
  return {{0, 0, 2}, {0, 0, -1}, Spectrum::constant(3), Float(drop_at(full_deg)), Float(drop_at(dark_deg))};
}
Vec3 below(double angle_deg) {
  const double angle = angle_deg * kPi64 / 180;
  return {Float(std::sin(angle)), 0, Float(-std::cos(angle))};
}

TEST(SpotLight, FadesFromItsFalloffToItsCone) {
  const SpotLight spot = spot_light(20, 30);
  for (double angle : {0.0, 10.0, 19.99}) EXPECT_EQ(spot.share_towards(below(angle)), 1) << angle;
  for (double angle : {30.01, 60.0, 180.0}) EXPECT_EQ(spot.share_towards(below(angle)), 0) << angle;
  for (double angle : {21.0, 24.0, 27.5}) {
    const double t = (drop_at(30) - drop_at(angle)) / (drop_at(30) - drop_at(20));
    EXPECT_NEAR(spot.share_towards(below(angle)), 3 * t * t - 2 * t * t * t, 1e-5) << angle;
  }
  const double middle = std::acos((std::cos(20 * kPi64 / 180) + std::cos(30 * kPi64 / 180)) / 2);
  EXPECT_NEAR(spot.share_towards(below(middle * 180 / kPi64)), 0.5, 1e-5);
}

TEST(SpotLight, MayBeNarrowOrHaveAHardEdge) {
  // A hundredth of a degree: 1 - cosine is 1.5e-8, less than a rounding step of the cosine itself.
  const SpotLight narrow = spot_light(0.005, 0.01);
  EXPECT_EQ(narrow.share_towards(below(0.0049)), 1);
  EXPECT_EQ(narrow.share_towards(below(0.0101)), 0);
  const double t = (1 - 0.75 * 0.75) / (1 - 0.25);
  EXPECT_NEAR(narrow.share_towards(below(0.0075)), 3 * t * t - 2 * t * t * t, 1e-3);
  const SpotLight hard = spot_light(25, 25);
  EXPECT_EQ(hard.share_towards(below(24.999)), 1);
  EXPECT_EQ(hard.share_towards(below(25.001)), 0);
}

TEST(SpotLight, PowerIsTheIntegralOfItsIntensity) {
  for (const auto& [full, dark] : {std::pair{20.0, 30.0}, {0.0, 180.0}, {70.0, 100.0}}) {
    const SpotLight spot = spot_light(full, dark);
    double integral = 0;
    constexpr int kSteps = 20000;
    for (int i = 0; i < kSteps; ++i) {
      const double z = 1 - 2 * (i + 0.5) / kSteps;
      const Vec3 way{Float(std::sqrt(1 - z * z)), 0, Float(z)};
      integral += 4 * kPi64 / kSteps * 3 * double(spot.share_towards(way));
    }
    const Lights lights({}, {}, {}, {spot}, std::nullopt, WavelengthDistribution::uniform({}), 1);
    EXPECT_NEAR(lights.power(550) / integral, 1, 1e-3) << full << ' ' << dark;
  }
}

TEST(SpotLight, LightsAPointWithItsIntensityByDistanceSquared) {
  const Lights lights({}, {}, {}, {spot_light(20, 30)}, std::nullopt, WavelengthDistribution::uniform({}), 1);
  const SampledWavelengths lambda = WavelengthDistribution::uniform({}).sample(Float(0.2));
  const auto centre = lights.sample_delta(0, {0, 0, -1}, lambda);
  ASSERT_TRUE(centre);
  EXPECT_NEAR(centre->radiance[0], 3 / 9.0, 1e-6);
  EXPECT_NEAR(centre->wi.z, 1, 1e-6);
  EXPECT_TRUE(lights.sample_delta(0, {2, 0, 0}, lambda)->radiance.is_zero());  // 45 degrees off the axis
  EXPECT_FALSE(lights.sample_delta(0, {0, 0, 2}, lambda));                     // at the light itself
}

TEST(Lights, NoneMeansNoChoice) { EXPECT_FALSE(Lights().choose({}, Float(0.5))); }

TEST(GridDensity, SamplesAsItsPdfSays) {
  const GridDensity density(3, 2, {1, 0, 3, 0, 0, 4});
  EXPECT_NEAR(density.pdf({Float(0.1), Float(0.1)}), 6 / 8.0, 1e-6);
  EXPECT_EQ(density.pdf({Float(0.5), Float(0.1)}), 0);
  EXPECT_NEAR(density.pdf({Float(0.9), Float(0.9)}), 4 * 6 / 8.0, 1e-6);
  for (int i = 0; i <= 100; ++i) {
    for (int j = 0; j <= 100; ++j) {
      const auto s = density.sample({Float(i) / 100, Float(j) / 100});
      EXPECT_GT(s.pdf, 0);
      EXPECT_EQ(s.pdf, density.pdf(s.position));
      EXPECT_TRUE(s.position.x >= 0 && s.position.x <= 1 && s.position.y >= 0 && s.position.y <= 1);
    }
  }
}

TEST(GridDensity, DarknessIsUniform) {
  const GridDensity density(4, 4, std::vector<double>(16, 0));
  EXPECT_NEAR(density.sample({Float(0.3), Float(0.7)}).pdf, 1, 1e-6);
}

Environment test_sky() {
  Image image(16, 8, {"R", "G", "B"});
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < 16; ++x) {
      for (int c = 0; c < 3; ++c) image.at(x, y, c) = float((x * 7 + y * 13 + c) % 11);
    }
  }
  image.at(5, 3, 0) = image.at(5, 3, 1) = image.at(5, 3, 2) = 1e4F;
  Transform turn;
  turn.m = {{{0, -1, 0, 0}, {1, 0, 0, 0}, {0, 0, 1, 0}}};
  return {image, "sky", Spectrum::constant(1), turn};
}

TEST(Environment, SamplesAsItsPdfSays) {
  const Environment sky = test_sky();
  std::mt19937 random(6);
  std::uniform_real_distribution<double> uniform;
  constexpr int kSamples = 20000;
  int differing = 0;
  for (int i = 0; i < kSamples; ++i) {
    const auto s = sky.sample({Float(uniform(random)), Float(uniform(random))});
    ASSERT_TRUE(s);
    EXPECT_NEAR(length(s->wi), 1, 1e-5);
    differing += std::abs(sky.pdf(s->wi) / s->pdf - 1) > Float(1e-3) ? 1 : 0;
  }
  // At a cell's border a rounding step may lead to the neighbour.
  EXPECT_LE(differing, 20);
}

TEST(Environment, ConstantLightIsLeftToBsdfSampling) {
  const Environment sky(Spectrum::constant(3));
  EXPECT_EQ(sky.sampled_share(), 0);
  EXPECT_FALSE(sky.sample({Float(0.3), Float(0.6)}));
  EXPECT_EQ(sky.pdf({0, 0, 1}), 0);
  const Lights lights({}, {}, {}, {}, sky, WavelengthDistribution::uniform({}), 1);
  EXPECT_EQ(lights.probability(lights.environment_index(), {}), 0);
  EXPECT_FALSE(lights.choose({}, Float(0.5)));
}

TEST(Environment, PdfIntegratesToOneAndCoversWhatIsBrighterThanTheMean) {
  const Environment sky = test_sky();
  const SampledWavelengths lambda = WavelengthDistribution::uniform({}).sample(Float(0.2));
  double sum = 0, largest_ratio = 0, mean = 0;
  constexpr int kSteps = 800;
  for (int i = 0; i < kSteps; ++i) {
    const double z = -1 + 2 * (i + 0.5) / kSteps, r = std::sqrt(1 - z * z);
    for (int j = 0; j < 2 * kSteps; ++j) {
      const double phi = 2 * kPi64 * (j + 0.5) / (2 * kSteps);
      const Vec3 direction{Float(r * std::cos(phi)), Float(r * std::sin(phi)), Float(z)};
      const double pdf = sky.pdf(direction), value = sky.radiance(direction, lambda)[0];
      sum += pdf;
      mean += value;
      // Together with directions drawn evenly, as a matt surface draws them at worst.
      largest_ratio = std::max(largest_ratio, value / (pdf + 1 / (4 * kPi64)));
    }
  }
  const double cell = 4 * kPi64 / (2.0 * kSteps * kSteps);
  EXPECT_NEAR(sum * cell, 1, 2e-3);
  EXPECT_GT(sky.sampled_share(), 0);
  EXPECT_LT(sky.sampled_share(), 1);
  // No firefly: the bilinear image is at most 4 times its mean over a quarter texel; 1.6 for sinθ near the
  // poles and for colours, whose luminance is not their radiance at this wavelength.
  EXPECT_LT(largest_ratio, 4 * 1.6 * mean * cell);
  EXPECT_NEAR(sky.mean_radiance(lambda.lambda_nm(0)) * 4 * kPi64 / (mean * cell), 1, 0.2);
}

}  // namespace
}  // namespace spectrace
