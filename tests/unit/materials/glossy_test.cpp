// SPDX-License-Identifier: Apache-2.0
#include "materials/glossy.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>

#include "core/math/math.h"
#include "materials/conductor.h"
#include "materials/lambert.h"
#include "tests/support/chi_square.h"

namespace spectrace {
namespace {

constexpr double kRounding = 8 * std::numeric_limits<Float>::epsilon();

SampledWavelengths wavelengths() {
  std::array<Float, kLanes> nm{}, pdf{};
  for (int i = 0; i < kLanes; ++i) nm[std::size_t(i)] = Float(420 + 80 * i);
  pdf.fill(1);
  return {nm, pdf};
}

Vec3 random_direction(test::TestRandom& random) {
  return normalize(
      {random.uniform() - Float(0.5), random.uniform() - Float(0.5), random.uniform() + Float(0.01)});
}

TEST(Lambert, IsReflectanceOverPiAtTheShadingPoint) {
  const SampledWavelengths lambda = wavelengths();
  const Lambert checked{Checkerboard{
      .even = Spectrum::constant(Float(0.2)), .odd = Spectrum::constant(Float(0.8)), .repeat_u = 2}};
  const Vec3 w = normalize({1, 2, 3});
  const auto albedo = [&](Vec2 uv) {
    const BsdfValue v = checked.evaluate({0, 0, 1}, w, {.lambda = lambda, .uv = uv});
    return double(v.value_cos[0]) * kPi64 / w.z;
  };
  EXPECT_NEAR(albedo({Float(0.1), Float(0.1)}), 0.2, kRounding);
  EXPECT_NEAR(albedo({Float(0.6), Float(0.1)}), 0.8, kRounding);
}

TEST(Glossy, IsLambertAndRoughMetalInTheirShares) {
  const SampledWavelengths lambda = wavelengths();
  const ShadingPoint at{.lambda = lambda};
  const ConductorFresnel metal{.eta = TabulatedSpectrum({400, 700}, {Float(1.5), Float(0.2)}),
                               .k = TabulatedSpectrum({400, 700}, {Float(1.9), Float(4)}),
                               .film = ThinFilm{.eta = Spectrum::constant(2), .thickness_nm = 300}};
  const Lambert diffuse{Spectrum(TabulatedSpectrum({400, 700}, {Float(0.1), Float(0.9)}))};
  const RoughConductor specular{metal, {Float(0.2), Float(0.5)}};
  const Glossy both{.reflectance = diffuse.reflectance,
                    .fresnel = metal,
                    .ggx = specular.ggx,
                    .diffuse_scale = Float(0.3),
                    .specular_scale = Float(0.6)};
  test::TestRandom random(3);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 wo = random_direction(random), wi = random_direction(random);
    const LobeValues lobes = both.evaluate_lobes(wo, wi, at);
    const SampledSpectrum d = diffuse.evaluate(wo, wi, at).value_cos,
                          s = specular.evaluate(wo, wi, at).value_cos;
    for (int lane = 0; lane < kLanes; ++lane) {
      EXPECT_NEAR(lobes.diffuse[lane], 0.3 * double(d[lane]), kRounding * double(d[lane]));
      EXPECT_NEAR(lobes.fresnel[lane], 0.6 * double(s[lane]), kRounding * double(s[lane]));
    }
    EXPECT_TRUE(lobes.diffraction.is_zero());
  }
}

TEST(Glossy, NeverChoosesAnEmptyLobe) {
  const SampledWavelengths lambda = wavelengths();
  const ShadingPoint at{.lambda = lambda};
  Glossy g{.reflectance = Spectrum::constant(Float(0.5)),
           .fresnel = SchlickFresnel{Spectrum::constant(Float(0.04))},
           .ggx = {Float(0.2), Float(0.2)}};
  for (const auto& [diffuse, specular] :
       {std::pair{Float(0), Float(1)}, {Float(1), Float(0)}, {Float(0), Float(0)}}) {
    g.diffuse_scale = diffuse;
    g.specular_scale = specular;
    for (const Float u : {Float(0), Float(0.5), kOneMinusEpsilon, Float(1)}) {
      const auto s = g.sample({0, 0, 1}, {.lobe = u, .direction = {Float(0.4), Float(0.3)}}, at);
      ASSERT_EQ(s.has_value(), diffuse + specular > 0);
      if (s) {
        EXPECT_EQ(s->lobe, specular > 0 ? Lobe::kSpecular : Lobe::kDiffuse);
      }
    }
  }
}

}  // namespace
}  // namespace spectrace
