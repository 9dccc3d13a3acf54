// SPDX-License-Identifier: Apache-2.0
#include "materials/diffractive.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "core/math/math.h"
#include "materials/glossy.h"
#include "tests/support/chi_square.h"

namespace spectrace {
namespace {

constexpr double kRounding = 16 * std::numeric_limits<Float>::epsilon();

SampledWavelengths wavelengths() {
  std::array<Float, kLanes> nm{}, pdf{};
  for (int i = 0; i < kLanes; ++i) nm[std::size_t(i)] = Float(420 + 80 * i);
  pdf.fill(1);
  return {nm, pdf};
}

Diffractive etched(Float rms_nm) {
  return {.reflectance = Spectrum::constant(Float(0.5)),
          .fresnel = ConductorFresnel{.eta = Spectrum::constant(1), .k = Spectrum::constant(3), .film = {}},
          .ggx = {Float(0.05), Float(0.05)},
          .micro = {.rms_nm = rms_nm, .correlation_nm = 3000, .exponent = Float(3.5)},
          .diffuse_scale = Float(0.4),
          .specular_scale = Float(0.6)};
}

Vec3 at_angle(double theta_deg) {
  const double theta = theta_deg * kPi64 / 180;
  return {Float(std::sin(theta)), 0, Float(std::cos(theta))};
}

TEST(MicroRoughness, DiffractsTheTotalIntegratedScatter) {
  // At σ = λ / 4π and normal incidence the exponent of the total integrated scatter is 1.
  const MicroRoughness micro{.rms_nm = Float(500 / (4 * kPi64))};
  EXPECT_NEAR(micro.diffracted(1, 500), 1 - std::exp(-1.0), kRounding);
  EXPECT_NEAR(micro.diffracted(Float(0.5), 500), 1 - std::exp(-0.25), kRounding);
  EXPECT_NEAR(micro.diffracted(1, 1000), 1 - std::exp(-0.25), kRounding);
  EXPECT_EQ(micro.diffracted(0, 500), 0);
  EXPECT_EQ(MicroRoughness{}.diffracted(1, 500), 0);
}

TEST(MicroRoughness, RadiiFollowTheDensity) {
  for (const Float exponent : {Float(2.5), Float(3), Float(6)}) {
    const MicroRoughness micro{.rms_nm = 1, .correlation_nm = 2000, .exponent = exponent};
    double inside = 0, last = 0;
    constexpr int kSteps = 2000;
    for (int i = 1; i <= kSteps; ++i) {  // ∫ 2π x S(x²) dx, to a share of 80 %
      const double x = double(micro.sample_radius(Float(0.8 * i / kSteps), 600)), middle = (x + last) / 2;
      inside += 2 * kPi64 * middle * (x - last) * double(micro.density(Float(middle * middle), 600));
      last = x;
      EXPECT_NEAR(inside, 0.8 * i / kSteps, 2e-4) << exponent;  // midpoint rule over 2000 steps
    }
  }
}

TEST(Diffractive, IsGlossyWhereItsMicroRoughnessIsZero) {
  const Diffractive smooth = etched(0);
  Glossy glossy;
  glossy.reflectance = smooth.reflectance;
  glossy.fresnel = smooth.fresnel;
  glossy.ggx = smooth.ggx;
  glossy.diffuse_scale = smooth.diffuse_scale;
  glossy.specular_scale = smooth.specular_scale;
  const SampledWavelengths lambda = wavelengths();
  const ShadingPoint at{.lambda = lambda};
  test::TestRandom random(3);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 wo =
        normalize({random.uniform() - Float(0.5), random.uniform(), random.uniform() + Float(0.01)});
    const Vec3 wi =
        normalize({random.uniform() - Float(0.5), -random.uniform(), random.uniform() + Float(0.01)});
    const BsdfValue a = smooth.evaluate(wo, wi, at), b = glossy.evaluate(wo, wi, at);
    EXPECT_NEAR(double(a.value_cos[0]), double(b.value_cos[0]), kRounding * double(b.value_cos[0]));
    EXPECT_NEAR(double(a.pdf), double(b.pdf), kRounding * double(b.pdf));
    EXPECT_TRUE(smooth.evaluate_lobes(wo, wi, at).diffraction.is_zero());
  }
}

TEST(Diffractive, SpreadsRedFartherThanBlueAndMirrorsMoreOfIt) {
  const Diffractive material = etched(40);
  const SampledWavelengths lambda = wavelengths();
  const ShadingPoint at{.lambda = lambda};
  const Vec3 wo = at_angle(30), mirror = at_angle(-30);
  const LobeValues highlight = material.evaluate_lobes(wo, mirror, at);
  const LobeValues near = material.evaluate_lobes(wo, at_angle(-33), at);
  const LobeValues far = material.evaluate_lobes(wo, at_angle(20), at);
  const int red = kLanes - 1;
  EXPECT_GT(highlight.fresnel[red], highlight.fresnel[0]);  // less roughness per wavelength
  // The slope of the halo between near and far is that of S: gentler in red.
  EXPECT_GT(far.diffraction[red] / near.diffraction[red], far.diffraction[0] / near.diffraction[0]);
  EXPECT_EQ(far.diffuse[red], far.diffuse[0]);
}

TEST(Diffractive, IsAMirrorAgainAtGrazing) {
  // The share diffracted falls with cos²: what is rough from above is smooth from the side.
  const Diffractive material = etched(60);
  const SampledWavelengths lambda = wavelengths();
  const ShadingPoint at{.lambda = lambda};
  const auto mirrored_share = [&](double theta_deg) {
    const LobeValues lobes = material.evaluate_lobes(at_angle(theta_deg), at_angle(-theta_deg), at);
    return double(lobes.fresnel[0] / (lobes.fresnel[0] + lobes.diffraction[0]));
  };
  EXPECT_LT(mirrored_share(0), mirrored_share(60));
  EXPECT_LT(mirrored_share(60), mirrored_share(80));
  EXPECT_GT(mirrored_share(80), 0.99);
}

}  // namespace
}  // namespace spectrace
