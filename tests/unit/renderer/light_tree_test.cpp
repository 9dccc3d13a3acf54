// SPDX-License-Identifier: Apache-2.0
// The choice among many lights: what is drawn is what probability() says, and nothing that shines is left
// out.
#include "renderer/light_tree.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numeric>

#include "core/math/math.h"
#include "renderer/lights.h"
#include "tests/support/chi_square.h"

namespace spectrace {
namespace {

using test::TestRandom;

Float between(TestRandom& random, Float low, Float high) { return low + (high - low) * random.uniform(); }
Vec3 point_in(TestRandom& random, Float half) {
  const Float x = between(random, -half, half), y = between(random, -half, half);
  return {x, y, between(random, -half, half)};
}
Vec3 direction(TestRandom& random) {
  const Float z = between(random, -1, 1), phi = between(random, 0, 2 * kPi);
  const Float r = safe_sqrt(1 - z * z);
  return {r * std::cos(phi), r * std::sin(phi), z};
}
/// Every fourth takes light from both sides.
Receiver receiver_in(TestRandom& random, Float half) {
  const Vec3 position = point_in(random, half), normal = direction(random);
  return {position, random.uniform() < Float(0.25) ? Vec3{} : normal};
}

LightShape shape_of_kind(int kind, TestRandom& random, Vec3 position, Float size) {
  const Vec3 u = direction(random) * size, v = cross(direction(random), u);
  if (kind == 0) return Sphere{position, size};
  if (kind == 1) return Quad{position, u, v};
  if (kind == 2) return Disk{position, u, v};
  return TriangleLight{position, u, v};
}

/// `count` area lights of all kinds within [-half, half]³, of one to 100 times the least radiance.
std::vector<Lights::AreaLight> area_lights(int count, Float half, std::uint64_t seed = 1) {
  TestRandom random(seed);
  std::vector<Lights::AreaLight> lights;
  for (int i = 0; i < count; ++i) {
    const Vec3 position = point_in(random, half);
    lights.push_back({shape_of_kind(i % 4, random, position, half * between(random, Float(1e-3), Float(0.1))),
                      std::uint32_t(i)});
  }
  return lights;
}

Lights make_lights(std::vector<Lights::AreaLight> area, std::vector<DeltaLight> delta, bool sky) {
  std::vector<Spectrum> emissions;
  for (std::size_t i = 0; i < area.size(); ++i) {
    emissions.push_back(Spectrum::constant(std::pow(Float(10), Float(i % 3))));
  }
  const std::vector<std::uint32_t> groups(area.size(), 1);
  return {std::move(area),
          groups,
          std::move(emissions),
          std::move(delta),
          sky ? std::optional<Environment>(Environment(Spectrum::constant(Float(0.1)))) : std::nullopt,
          WavelengthDistribution::uniform({}),
          2};
}

/// Of every kind, in a cube from -1 to 1.
Lights mixed_lights(int area_count) {
  std::vector<DeltaLight> delta;
  TestRandom random(7);
  for (int i = 0; i < 6; ++i) {
    delta.emplace_back(PointLight{point_in(random, 1), Spectrum::constant(Float(0.1))});
    const Vec3 position = point_in(random, 1);
    delta.emplace_back(SpotLight{position, direction(random), Spectrum::constant(Float(0.3)), Float(0.05),
                                 i < 3 ? Float(0.2) : Float(1.5)});
  }
  delta.emplace_back(DirectionalLight{{0, 0, 1}, Spectrum::constant(2)});
  delta.emplace_back(DirectionalLight{{1, 0, 0}, Spectrum::constant(1)});
  return make_lights(area_lights(area_count, 1), std::move(delta), true);
}
std::uint32_t light_count(const Lights& lights) {
  return std::uint32_t(lights.area_count() + lights.delta_count() + (lights.environment() ? 1 : 0));
}

// Single precision over a few hundred sums and eight levels: 1e-6 observed.
constexpr double kSumTolerance = 1e-5;

TEST(LightChoice, ProbabilitiesSumToOneWhereAllLightsMayBeSeen) {
  for (int count : {1, 3, 10, 300}) {
    std::vector<Lights::AreaLight> spheres;
    TestRandom random(2);
    for (int i = 0; i < count; ++i) {
      spheres.push_back(
          {Sphere{point_in(random, 1), between(random, Float(0.01), Float(0.1))}, std::uint32_t(i)});
    }
    const Lights lights =
        make_lights(spheres, {DirectionalLight{{0, 0, 1}, Spectrum::constant(2)}}, count % 2 == 0);
    for (int trial = 0; trial < 100; ++trial) {
      const Receiver receiver{point_in(random, 2), {}};
      double sum = 0;
      for (std::uint32_t light = 0; light < light_count(lights); ++light) {
        sum += double(lights.probability(light, receiver));
      }
      EXPECT_NEAR(sum, 1, kSumTolerance) << count << " area lights";
    }
  }
}

TEST(LightChoice, NoLightWithPowerHasProbabilityZero) {
  const Lights lights = mixed_lights(100);
  TestRandom random(2);
  for (int trial = 0; trial < 100; ++trial) {
    const Receiver receiver = receiver_in(random, 2);
    double sum = 0;
    for (std::uint32_t light = 0; light < light_count(lights); ++light) {
      const Float p = lights.probability(light, receiver);
      // A constant environment is left to BSDF sampling.
      EXPECT_TRUE(p > 0 || light == lights.environment_index());
      sum += double(p);
    }
    EXPECT_LT(sum, 1 + kSumTolerance);  // the rest leads to parts of the tree that turn away as a whole
  }
}

TEST(LightChoice, GivesItsProbabilityBitForBit) {
  const Lights lights = mixed_lights(300);
  TestRandom random(3);
  for (int trial = 0; trial < 20000; ++trial) {
    const Receiver receiver = receiver_in(random, 2);
    const auto choice = lights.choose(receiver, random.uniform());
    if (!choice) continue;
    ASSERT_EQ(choice->probability, lights.probability(choice->light, receiver));
  }
  for (Float u : {Float(0), kOneMinusEpsilon}) {
    const Receiver receiver = receiver_in(random, 2);
    const auto choice = lights.choose(receiver, u);
    ASSERT_TRUE(choice);
    EXPECT_EQ(choice->probability, lights.probability(choice->light, receiver));
  }
}

/// p-value of draws over all lights, and none, against probability(); what few draws fall on counts as one.
double choice_p_value(const Lights& lights, const Receiver& receiver, std::uint64_t seed) {
  constexpr int kDraws = 100000;
  TestRandom random(seed);
  std::map<std::uint32_t, int> counts;
  const std::uint32_t none = light_count(lights);
  for (int i = 0; i < kDraws; ++i) {
    const auto choice = lights.choose(receiver, random.uniform());
    ++counts[choice ? choice->light : none];
  }
  double statistic = 0, rare = 0, rare_count = 0;
  int cells = 0;
  const auto add = [&](double expected, double count) {
    statistic += sqr(count - expected) / expected;
    ++cells;
  };
  double rest = kDraws;
  for (std::uint32_t light = 0; light <= none; ++light) {
    const double expected = light == none ? rest : kDraws * double(lights.probability(light, receiver));
    rest -= expected;
    if (expected < 10) {
      rare += expected;
      rare_count += counts[light];
    } else {
      add(expected, counts[light]);
    }
  }
  if (rare > 10) add(rare, rare_count);
  return test::chi_square_p_value(statistic, cells - 1);
}

TEST(LightChoice, DrawsAsProbabilitySays) {
  constexpr int kReceivers = 10;
  const std::vector<int> sizes{0, 3, 40, 300};
  const double level = test::sidak_level(0.01, kReceivers * sizes.size());
  TestRandom random(4);
  for (int size : sizes) {
    const Lights lights = mixed_lights(size);
    for (int i = 0; i < kReceivers; ++i) {
      EXPECT_GT(choice_p_value(lights, receiver_in(random, Float(1.5)), std::uint64_t(100 + i)), level);
    }
  }
}

/// The tree alone, without the table that covers its gaps.
struct TreeOf {
  explicit TreeOf(const std::vector<Lights::AreaLight>& lights) : tree(leaves(lights), lights.size()) {}
  static std::vector<LightTree::Leaf> leaves(const std::vector<Lights::AreaLight>& lights) {
    std::vector<LightTree::Leaf> result;
    for (const Lights::AreaLight& light : lights) {
      result.push_back({std::uint32_t(result.size()), light_bounds(light.shape, 1)});
    }
    return result;
  }
  [[nodiscard]] Float probability(std::uint32_t light, const Receiver& receiver) const {
    return tree.probability(LightTree::Cut(tree, receiver), receiver, light);
  }
  LightTree tree;
};

TEST(LightTree, LeavesOutNothingThatShines) {
  const std::vector<Lights::AreaLight> lights = area_lights(400, 1);
  const TreeOf tree(lights);
  TestRandom random(5);
  int lit = 0;
  for (int trial = 0; trial < 100000; ++trial) {
    const Receiver receiver = receiver_in(random, Float(1.2));
    const auto light = std::uint32_t(random.uniform() * Float(lights.size()));
    const auto point = sample_light(lights[light].shape, receiver.position, random.uniform2());
    if (!point || (!(receiver.normal == Vec3{}) && !(dot(point->wi, receiver.normal) > 0))) continue;
    ++lit;
    EXPECT_GT(tree.probability(light, receiver), 0) << "light " << light;
  }
  EXPECT_GT(lit, 10000);
}

TEST(LightTree, FavoursWhatIsNearAndFaces) {
  // Of equal squares, one near and turned to the receiver, one as near and turned away, 200 far ones.
  std::vector<Lights::AreaLight> lights{{Quad{{0, 0, 1}, {0, Float(0.1), 0}, {Float(0.1), 0, 0}}},
                                        {Quad{{Float(0.2), 0, 1}, {Float(0.1), 0, 0}, {0, Float(0.1), 0}}}};
  TestRandom random(6);
  for (int i = 0; i < 200; ++i) {
    const Float phi = 2 * kPi * random.uniform(), r = between(random, 20, 60);
    lights.push_back(
        {Quad{{r * std::cos(phi), r * std::sin(phi), 1}, {0, Float(0.1), 0}, {Float(0.1), 0, 0}}});
  }
  const TreeOf tree(lights);
  const Receiver receiver{{0, 0, 0}, {0, 0, 1}};
  EXPECT_GT(tree.probability(0, receiver), Float(0.9));
  EXPECT_LT(tree.probability(1, receiver), Float(0.01));
}

TEST(LightTree, DoesNotKnowTheUnitOfLength) {
  TestRandom random(8);
  const Receiver receiver = receiver_in(random, 1);
  std::vector<double> expected;
  for (Float scale : {Float(1), Float(1e-4), Float(1e6)}) {
    const TreeOf tree(area_lights(100, scale));
    const Receiver scaled{receiver.position * scale, receiver.normal};
    for (std::uint32_t light = 0; light < 100; ++light) {
      const double p = double(tree.probability(light, scaled));
      if (scale == 1) {
        expected.push_back(p);
      } else {
        // 1e-6: of what hardly shines this way, cancellation leaves few digits.
        EXPECT_NEAR(p, expected[light], 1e-3 * expected[light] + 1e-6) << "scale " << scale;
      }
    }
  }
}

double sum_of_probabilities(const TreeOf& tree, std::size_t count, const Receiver& receiver) {
  double sum = 0;
  for (std::uint32_t light = 0; light < count; ++light) sum += double(tree.probability(light, receiver));
  return sum;
}

TEST(LightTree, HoldsLightsInOnePlaceAndAtEveryScale) {
  std::vector<Lights::AreaLight> same, shrinking;
  for (int i = 0; i < 1000; ++i) same.push_back({Sphere{{1, 2, 3}, Float(0.1)}});
  // Each half as far from the origin as the one before: what part by part cuts off one light at a time.
  for (int i = 0; i < 60; ++i) {
    const Float distance = std::ldexp(Float(1), 20 - i);
    shrinking.push_back({Sphere{{distance, 0, 0}, distance * Float(0.01)}});
  }
  for (const Vec3 position : {Vec3{0, 0, 0}, Vec3{1, 2, 3}, Vec3{100, 0, 0}}) {
    const Receiver receiver{position, {}};
    EXPECT_NEAR(sum_of_probabilities(TreeOf(same), same.size(), receiver), 1, kSumTolerance);
    EXPECT_NEAR(sum_of_probabilities(TreeOf(shrinking), shrinking.size(), receiver), 1, kSumTolerance);
  }
}

TEST(LightTree, HoldsAMeshOfAHundredThousandTriangles) {
  constexpr int kRings = 158, kSegments = 316;  // 2 · 158 · 316 = 99,856 triangles of a sphere
  const auto at = [](int i, int j) {
    const Float theta = kPi * Float(i) / kRings, phi = 2 * kPi * Float(j) / kSegments;
    return Vec3{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
  };
  std::vector<Lights::AreaLight> lights;
  for (int i = 0; i < kRings; ++i) {
    for (int j = 0; j < kSegments; ++j) {
      const Vec3 a = at(i, j), b = at(i + 1, j), c = at(i + 1, j + 1), d = at(i, j + 1);
      lights.push_back({TriangleLight{a, b - a, c - a}});
      lights.push_back({TriangleLight{a, c - a, d - a}});
    }
  }
  std::erase_if(lights, [](const auto& light) { return !(light_area(light.shape) > 0); });  // the poles
  const TreeOf tree(lights);
  const Receiver receiver{{0, 0, Float(1.5)}, {0, 0, -1}};
  EXPECT_NEAR(sum_of_probabilities(tree, lights.size(), receiver), 1, 1e-4);
  const LightTree::Cut cut(tree.tree, receiver);
  TestRandom random(9);
  double facing = 0;
  constexpr int kDraws = 2000;
  for (int i = 0; i < kDraws; ++i) {
    const LightTree::Choice choice = tree.tree.choose(cut, receiver, random.uniform());
    EXPECT_EQ(choice.probability, tree.tree.probability(cut, receiver, choice.light));
    facing += sample_light(lights[choice.light].shape, receiver.position, {Float(0.3), Float(0.3)}) ? 1 : 0;
  }
  // Of the sphere's area 1/6 is seen from here: 0.9 observed, with what half faces at the rim.
  EXPECT_GT(facing / kDraws, 0.8);
}

TEST(LightTree, OfNothingGivesNothing) {
  const LightTree tree;
  EXPECT_EQ(LightTree::Cut(tree, {}).sum(), 0);
  EXPECT_EQ(tree.probability(LightTree::Cut(tree, {}), {}, 0), 0);
}

}  // namespace
}  // namespace spectrace
