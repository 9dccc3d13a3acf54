// SPDX-License-Identifier: Apache-2.0
// The judge is judged first: known p-values, a right sampler passes, wrong ones fail.
#include "tests/support/chi_square.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/math/math.h"

namespace spectrace::test {
namespace {

constexpr double kLevel = 1e-4;  // one planted fault must be found far below any level the suite uses

SamplingTestOptions quick(std::uint64_t seed) {
  SamplingTestOptions options;
  options.samples = 200'000;
  options.pilots = 50'000;
  options.seed = seed;
  return options;
}

/// Density proportional to cos^n. Around the normal cosθ has no digits left for n = 1e6: sinθ has.
std::optional<Vec3> draw_cosine_power(TestRandom& random, double n) {
  const Vec2 u = random.uniform2();
  const double log_z = std::log1p(-double(u.x)) / (n + 1);
  const double r = std::sqrt(-std::expm1(2 * log_z)), phi = 2 * kPi64 * u.y;
  return Vec3{Float(r * std::cos(phi)), Float(r * std::sin(phi)), Float(std::exp(log_z))};
}
double cosine_power_density(Vec3 w, double n) {
  const double sin2 = double(w.x) * w.x + double(w.y) * w.y;
  const double z = w.z < 0.5 ? double(w.z) : std::sqrt(1 - sin2);
  return (n + 1) / (2 * kPi64) * std::pow(z, n);
}

TEST(ChiSquare, PValuesAgreeWithTables) {
  // NIST/SEMATECH e-handbook, sec. 1.3.6.7.4: upper critical values at 0.05 and 0.001, three decimals.
  EXPECT_NEAR(chi_square_p_value(3.841, 1), 0.05, 2e-5);
  EXPECT_NEAR(chi_square_p_value(18.307, 10), 0.05, 2e-5);
  EXPECT_NEAR(chi_square_p_value(124.342, 100), 0.05, 2e-5);
  EXPECT_NEAR(chi_square_p_value(149.449, 100), 0.001, 1e-6);
  EXPECT_EQ(chi_square_p_value(0, 5), 1);
}

TEST(ChiSquare, SidakKeepsTheFamilyLevel) {
  EXPECT_DOUBLE_EQ(sidak_level(0.01, 1), 0.01);
  EXPECT_NEAR(1 - std::pow(1 - sidak_level(0.01, 250), 250), 0.01, 1e-12);
}

TEST(ChiSquare, AcceptsARightSamplerHoweverNarrow) {
  for (const double n : {0.0, 1.0, 1e2, 1e4, 1e6}) {
    const SamplingTestResult r =
        test_sampling([n](TestRandom& random) { return draw_cosine_power(random, n); },
                      [n](Vec3 w) { return cosine_power_density(w, n); }, quick(std::uint64_t(n) + 7));
    EXPECT_GT(r.p_value, kLevel) << n << ": " << r.text();
    EXPECT_GT(r.p_value_kept, kLevel) << n << ": " << r.text();
    EXPECT_NEAR(r.integral, 1, 1e-4) << n;
  }
}

TEST(ChiSquare, RejectsADensityOfTheWrongShape) {
  const SamplingTestResult r = test_sampling([](TestRandom& random) { return draw_cosine_power(random, 50); },
                                             [](Vec3 w) { return cosine_power_density(w, 52); }, quick(3));
  EXPECT_LT(r.p_value, kLevel) << r.text();
}

TEST(ChiSquare, RejectsADensityOfTheWrongScale) {
  const SamplingTestResult r =
      test_sampling([](TestRandom& random) { return draw_cosine_power(random, 50); },
                    [](Vec3 w) { return 1.01 * cosine_power_density(w, 50); }, quick(4));
  EXPECT_GT(r.p_value, kLevel) << "the shape is right: " << r.text();
  EXPECT_LT(r.p_value_kept, kLevel) << r.text();
}

TEST(ChiSquare, RejectsALobeWhereNothingIsDrawn) {
  const auto draw = [](TestRandom& random) { return draw_cosine_power(random, 1000); };
  const auto density = [](Vec3 w) {  // a tenth of the mass lies around the x axis, at 45 degrees
    const double cosine = (w.x + w.z) / std::numbers::sqrt2;
    return 0.9 * cosine_power_density(w, 1000) +
           0.1 * 1001 / (2 * kPi64) * std::pow(std::max(cosine, 0.0), 1000);
  };
  const SamplingTestResult r = test_sampling(draw, density, quick(5));
  EXPECT_LT(r.p_value, kLevel) << r.text();
}

TEST(ChiSquare, CountsLostSamples) {
  const auto draw = [](TestRandom& random) -> std::optional<Vec3> {
    if (random.uniform() < 0.25) return std::nullopt;
    return draw_cosine_power(random, 1);
  };
  const auto scaled = [](double s) { return [s](Vec3 w) { return s * cosine_power_density(w, 1); }; };
  EXPECT_GT(test_sampling(draw, scaled(0.75), quick(6)).p_value_kept, kLevel);
  EXPECT_LT(test_sampling(draw, scaled(1), quick(6)).p_value_kept, kLevel);
}

}  // namespace
}  // namespace spectrace::test
