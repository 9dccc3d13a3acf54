// SPDX-License-Identifier: Apache-2.0
#include "materials/microfacet.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>

#include "core/math/math.h"
#include "tests/support/chi_square.h"

namespace spectrace {
namespace {

constexpr std::array<Ggx, 4> kLobes{
    {{Float(0.05), Float(0.05)}, {Float(0.3), Float(0.3)}, {1, 1}, {Float(0.1), Float(0.6)}}};

/// ∫ g(w) dω over the hemisphere by midpoints in (tan^{1/2}-like s = θ², φ): dense around the normal, where
/// narrow lobes live.
double integrate(const std::function<double(Vec3)>& g) {
  constexpr int kTheta = 2000, kPhi = 256;
  double sum = 0;
  for (int i = 0; i < kTheta; ++i) {
    const double u = (i + 0.5) / kTheta, theta = u * u * kPi64 / 2;
    for (int j = 0; j < kPhi; ++j) {
      const double phi = 2 * kPi64 * (j + 0.5) / kPhi;
      sum += g({Float(std::sin(theta) * std::cos(phi)), Float(std::sin(theta) * std::sin(phi)),
                Float(std::cos(theta))}) *
             u * std::sin(theta);
    }
  }
  return sum * kPi64 / kTheta * 2 * kPi64 / kPhi;
}
constexpr double kQuadrature = 1e-4;  // midpoints of smooth integrands, 512 000 of them

TEST(Ggx, ProjectedAreaOfTheFacetsIsOne) {
  for (const Ggx& g : kLobes) {
    EXPECT_NEAR(integrate([&](Vec3 w) { return double(g.distribution(w)) * w.z; }), 1, kQuadrature)
        << g.alpha_x;
  }
}

TEST(Ggx, VisibleFacetsFillTheProjectedAreaOfTheSurface) {
  // cosθo = G1(wo) ∫ D max(0, wo·wm) dωm: Heitz 2014, eq. 16, what makes Smith's masking consistent.
  for (const Ggx& g : kLobes) {
    for (const double theta : {0.0, 0.8, 1.3, 1.5}) {
      const Vec3 wo{Float(std::sin(theta) * 0.6), Float(std::sin(theta) * 0.8), Float(std::cos(theta))};
      const double facets =
          integrate([&](Vec3 w) { return double(g.distribution(w)) * std::max(double(dot(wo, w)), 0.0); });
      EXPECT_NEAR(g.masking(wo) * facets, wo.z, 5 * kQuadrature) << g.alpha_x << " " << theta;
    }
  }
}

TEST(Ggx, ReflectionIsDTimesG2OverFourCosines) {
  test::TestRandom random(5);
  for (const Ggx& g : kLobes) {
    for (int i = 0; i < 200; ++i) {
      const Vec3 wo = normalize(
          {random.uniform() - Float(0.5), random.uniform() - Float(0.5), random.uniform() + Float(0.01)});
      const Vec3 wi = normalize(
          {random.uniform() - Float(0.5), random.uniform() - Float(0.5), random.uniform() + Float(0.01)});
      const auto lambda = [&](Vec3 w) {  // Heitz 2014, eqs. 86 and 72, written out
        const double a2 = (std::pow(double(g.alpha_x) * w.x, 2) + std::pow(double(g.alpha_y) * w.y, 2)) /
                          (double(w.z) * w.z);
        return (std::sqrt(1 + a2) - 1) / 2;
      };
      const double d = g.distribution(normalize(wo + wi));
      const Ggx::Reflection r = g.reflect(wo, wi);
      EXPECT_NEAR(r.value_cos / (d / (1 + lambda(wo) + lambda(wi)) / (4 * double(wo.z))), 1, 1e-5);
      EXPECT_NEAR(r.pdf / (d / (1 + lambda(wo)) / (4 * double(wo.z))), 1, 1e-5);
    }
  }
}

TEST(Ggx, EndsOfTheRandomNumbersGiveDirections) {
  const Ggx g{Float(0.3), Float(0.3)};
  for (const Float z : {Float(1), Float(0.5), Float(1e-4)}) {
    const Vec3 wo{std::sqrt(1 - z * z), 0, z};
    for (const Float x : {Float(0), Float(0.5), kOneMinusEpsilon, Float(1)}) {
      for (const Float y : {Float(0), Float(0.5), kOneMinusEpsilon, Float(1)}) {
        EXPECT_NEAR(length(g.sample(wo, {x, y})), 1, 1e-6) << z << " " << x << " " << y;
      }
    }
  }
}

}  // namespace
}  // namespace spectrace
