// SPDX-License-Identifier: Apache-2.0
// Mirror and glass: what the conformance suite cannot ask of them.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/math/math.h"
#include "materials/material.h"
#include "tests/support/shading_point.h"

namespace spectrace {
namespace {

constexpr double kRounding = 2e-6;  // a unit vector and a Fresnel term in single precision

using test::kAt;
using test::kLambda;

Vec3 at_angle(double theta_deg, bool above = true) {
  const double theta = theta_deg * kPi64 / 180;
  return {Float(std::sin(theta) * 0.8), Float(std::sin(theta) * -0.6),
          Float(above ? std::cos(theta) : -std::cos(theta))};
}
constexpr std::array kAngles{0.0, 30.0, 60.0, 79.0, 85.0, 89.9};

Dielectric flint() {  // dispersive: Schott SF11
  return {SellmeierSpectrum{.b = {Float(1.73759695), Float(0.313747346), Float(1.89878101)},
                            .c_um2 = {Float(0.013188707), Float(0.0623068142), Float(155.23629)}}};
}

TEST(SmoothConductor, MirrorsWithItsFresnelReflectance) {
  const SmoothConductor mirror{
      {.eta = Spectrum::constant(Float(0.2)), .k = Spectrum::constant(3), .film = {}}};
  for (const double angle : kAngles) {
    const Vec3 wo = at_angle(angle);
    const auto s = mirror.sample(wo, {}, kAt);
    ASSERT_TRUE(s);
    EXPECT_EQ(s->wi, (Vec3{-wo.x, -wo.y, wo.z}));
    EXPECT_TRUE(s->is_delta);
    EXPECT_EQ(s->pdf, 1);
    EXPECT_EQ(s->weight[0], fresnel_conductor(wo.z, Float(0.2), 3));
    EXPECT_EQ(mirror.evaluate(wo, s->wi, kAt).pdf, 0);
    EXPECT_FALSE(mirror.sample(at_angle(angle, false), {}, kAt));
  }
}

TEST(Dielectric, RefractsBySnellsLaw) {
  const Dielectric glass{Spectrum::constant(Float(1.5))};
  for (const bool above : {true, false}) {
    for (const double angle : {10.0, 30.0, 40.0}) {
      const Vec3 wo = at_angle(angle, above);
      const auto s = glass.sample(wo, {.lobe = kOneMinusEpsilon, .direction = {}}, kAt);
      ASSERT_TRUE(s);
      ASSERT_LT(s->wi.z * wo.z, 0);
      const double n_o = above ? 1 : 1.5, n_i = above ? 1.5 : 1;
      EXPECT_NEAR(n_o * wo.x, -n_i * s->wi.x, kRounding);
      EXPECT_NEAR(n_o * wo.y, -n_i * s->wi.y, kRounding);
      EXPECT_NEAR(length(s->wi), 1, kRounding);
      EXPECT_FALSE(s->is_dispersive);
    }
  }
}

TEST(Dielectric, ProbabilitiesSumToOneAndEnergyIsKept) {
  for (const Dielectric& glass : {Dielectric{Spectrum::constant(Float(1.5))}, flint()}) {
    for (const bool above : {true, false}) {
      for (const double angle : kAngles) {
        const Vec3 wo = at_angle(angle, above);
        const auto reflected = glass.sample(wo, {.lobe = 0, .direction = {}}, kAt);
        const auto other = glass.sample(wo, {.lobe = 1, .direction = {}}, kAt);
        ASSERT_TRUE(reflected && other);
        ASSERT_GT(reflected->wi.z * wo.z, 0);
        const bool refracts = other->wi.z * wo.z < 0;
        if (!refracts) {  // total reflection
          EXPECT_FALSE(above);
          EXPECT_EQ(reflected->pdf, 1);
          continue;
        }
        EXPECT_NEAR(reflected->pdf + other->pdf, 1, kRounding);
        const double eta = glass.eta.at(kLambda.lambda_nm(0)), scale = above ? eta * eta : 1 / (eta * eta);
        EXPECT_NEAR(reflected->weight[0] * reflected->pdf + other->weight[0] * scale * other->pdf, 1,
                    kRounding);
      }
    }
  }
}

TEST(Dielectric, UnderAFilmEveryLaneKeepsItsEnergy) {
  const Dielectric glass{Spectrum::constant(Float(1.5)),
                         ThinFilm{.eta = Spectrum::constant(Float(2.2)), .thickness_nm = 300}};
  for (const bool above : {true, false}) {
    for (const double angle : kAngles) {
      const Vec3 wo = at_angle(angle, above);
      const auto reflected = glass.sample(wo, {.lobe = 0, .direction = {}}, kAt);
      const auto refracted = glass.sample(wo, {.lobe = kOneMinusEpsilon, .direction = {}}, kAt);
      ASSERT_TRUE(reflected && refracted);
      if (refracted->wi.z * wo.z > 0) continue;  // total reflection
      EXPECT_FALSE(refracted->is_dispersive);
      EXPECT_NEAR(reflected->pdf + refracted->pdf, 1, kRounding);
      for (int i = 0; i < kLanes; ++i) {
        const double scale = above ? 1.5 * 1.5 : 1 / (1.5 * 1.5);
        EXPECT_NEAR(reflected->weight[i] * reflected->pdf + refracted->weight[i] * scale * refracted->pdf, 1,
                    2 * kRounding);
        if (above) {
          EXPECT_NEAR(reflected->weight[i] * reflected->pdf,
                      fresnel_thin_film(wo.z, kLambda.lambda_nm(i), Float(2.2), 300, Float(1.5), 0),
                      kRounding);
        }
      }
    }
  }
}

TEST(Dielectric, AQuarterWaveOfTheMeanIndexLetsAllThrough) {
  const Float film = std::sqrt(Float(1.5));
  const Dielectric glass{Spectrum::constant(Float(1.5)),
                         ThinFilm{.eta = Spectrum::constant(film), .thickness_nm = 500 / (4 * film)}};
  std::array<Float, kLanes> nm{}, density{};
  nm.fill(500);
  density.fill(1);
  const SampledWavelengths hero(nm, density);
  const auto s = glass.sample(at_angle(0), {.lobe = Float(1e-5), .direction = {}}, {.lambda = hero});
  ASSERT_TRUE(s);
  EXPECT_LT(s->wi.z, 0);
  EXPECT_NEAR(s->weight[0], 1 / (1.5 * 1.5), kRounding);
}

TEST(Dielectric, GoingInAndOutRestoresRadiance) {
  const Dielectric glass = flint();
  const auto in = glass.sample(at_angle(50), {.lobe = kOneMinusEpsilon, .direction = {}}, kAt);
  ASSERT_TRUE(in);
  const auto out = glass.sample(in->wi, {.lobe = kOneMinusEpsilon, .direction = {}}, kAt);
  ASSERT_TRUE(out);
  EXPECT_NEAR(in->weight[0] * out->weight[0], 1, kRounding);
  EXPECT_NEAR(length(out->wi - at_angle(50)), 0, 4 * kRounding);
}

TEST(Dielectric, OnlyRefractionDisperses) {
  const Dielectric glass = flint();
  const Vec3 wo = at_angle(60);
  const auto reflected = glass.sample(wo, {.lobe = 0, .direction = {}}, kAt);
  const auto refracted = glass.sample(wo, {.lobe = kOneMinusEpsilon, .direction = {}}, kAt);
  ASSERT_TRUE(reflected && refracted);
  EXPECT_FALSE(reflected->is_dispersive);
  EXPECT_TRUE(refracted->is_dispersive);
  for (int i = 0; i < kLanes; ++i) {  // each lane reflects by its own index, over the hero's probability
    EXPECT_NEAR(reflected->weight[i] * reflected->pdf,
                fresnel_dielectric(wo.z, glass.eta.at(kLambda.lambda_nm(i))), kRounding);
  }
}

TEST(Dielectric, MatchedIndexLetsAllThrough) {
  const Dielectric nothing{Spectrum::constant(1)};
  for (const double angle : kAngles) {
    const Vec3 wo = at_angle(angle);
    const auto s = nothing.sample(wo, {.lobe = 0, .direction = {}}, kAt);
    ASSERT_TRUE(s);
    EXPECT_NEAR(length(s->wi + wo), 0, kRounding);
    EXPECT_EQ(s->weight[0], 1);
  }
}

TEST(Material, DispatchKnowsDeltasAndTransmission) {
  EXPECT_TRUE(is_delta(Material(Dielectric{})));
  EXPECT_TRUE(is_transmissive(Material(Dielectric{})));
  EXPECT_TRUE(is_delta(Material(SmoothConductor{})));
  EXPECT_FALSE(is_transmissive(Material(SmoothConductor{})));
  EXPECT_FALSE(is_delta(Material(RoughConductor{})));
  EXPECT_FALSE(is_delta(Material(std::in_place_type<Lambert>)));
}

}  // namespace
}  // namespace spectrace
