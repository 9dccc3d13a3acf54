// SPDX-License-Identifier: Apache-2.0
// Materials made of others: what the conformance suite cannot ask of them.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/math/math.h"
#include "materials/material.h"
#include "tests/support/shading_point.h"

namespace spectrace {
namespace {

using test::kAt;
using test::kLambda;

const Vec3 kWo = normalize({Float(0.3), Float(-0.2), Float(0.7)}),
           kWi = normalize({Float(-0.4), Float(0.5), Float(0.6)});

Vec3 below(Vec3 w) { return {w.x, -w.y, -w.z}; }  // half a turn about x

Material grey(Float albedo) {
  Lambert lambert;  // assigned to: GCC 12 takes a moved variant for uninitialised
  lambert.reflectance = Texture(Spectrum::constant(albedo));
  return lambert;
}
Material brushed() {
  return RoughConductor{{.eta = Spectrum::constant(Float(0.2)), .k = Spectrum::constant(3)},
                        {Float(0.1), Float(0.4)}};
}
NormalTexture uniform_normal(Vec3 n) {
  Image image(1, 1, {"R", "G", "B"});
  image.data = {float(n.x + 1) / 2, float(n.y + 1) / 2, float(n.z + 1) / 2};
  return NormalTexture(CachedImage(image));
}

TEST(Nested, TwoSidesAreTwoMaterials) {
  const Material card = TwoSided(nest(grey(Float(0.8))), nest(brushed()));
  EXPECT_EQ(evaluate(card, kWo, kWi, kAt).value_cos, evaluate(grey(Float(0.8)), kWo, kWi, kAt).value_cos);
  EXPECT_EQ(evaluate(card, below(kWo), below(kWi), kAt).value_cos,
            evaluate(brushed(), kWo, kWi, kAt).value_cos);
  EXPECT_TRUE(evaluate(card, kWo, below(kWi), kAt).value_cos.is_zero());
  const auto s = sample(card, below(kWo), {Float(0.3), {Float(0.2), Float(0.6)}}, kAt);
  const auto front = sample(brushed(), kWo, {Float(0.3), {Float(0.2), Float(0.6)}}, kAt);
  ASSERT_TRUE(s && front);
  EXPECT_EQ(s->wi, below(front->wi));
}

TEST(Nested, MixesAreSums) {
  const auto mix = [](Float w) { return Material(Mix(nest(grey(Float(0.8))), nest(brushed()), w)); };
  const BsdfValue a = evaluate(grey(Float(0.8)), kWo, kWi, kAt), b = evaluate(brushed(), kWo, kWi, kAt);
  EXPECT_EQ(evaluate(mix(0), kWo, kWi, kAt).value_cos, a.value_cos);
  EXPECT_EQ(evaluate(mix(1), kWo, kWi, kAt).value_cos, b.value_cos);
  const BsdfValue m = evaluate(mix(Float(0.3)), kWo, kWi, kAt);
  EXPECT_NEAR(m.value_cos[1], 0.7 * a.value_cos[1] + 0.3 * b.value_cos[1], 1e-6);
  EXPECT_NEAR(m.pdf, 0.7 * a.pdf + 0.3 * b.pdf, 1e-6);
}

TEST(Nested, AMirrorInAMixKeepsItsShare) {
  const SmoothConductor mirror{{.eta = Spectrum::constant(Float(0.2)), .k = Spectrum::constant(3)}};
  const Material mix = Mix(nest(grey(Float(0.8))), nest(mirror), Float(0.25));
  EXPECT_FALSE(is_delta(mix));
  EXPECT_TRUE(has_delta_lobe(mix));
  const auto s = sample(mix, kWo, {Float(0.1), {}}, kAt);  // below the weight: the second
  ASSERT_TRUE(s && s->is_delta);
  EXPECT_EQ(s->pdf, Float(0.25));
  EXPECT_EQ(s->weight[0], fresnel_conductor(kWo.z, Float(0.2), 3));
  EXPECT_TRUE(is_delta(Material(Mix(nest(mirror), nest(Dielectric{}), Float(0.5)))));
}

TEST(Nested, HolesLetThroughWhatTheOpacityLeaves) {
  const Material leaf = Masked(nest(grey(Float(0.8))), Float(0.75));
  const auto through = sample(leaf, kWo, {Float(0.8), {}}, kAt);
  ASSERT_TRUE(through && through->passes && through->is_delta);
  EXPECT_EQ(through->wi, -kWo);
  EXPECT_EQ(through->weight, SampledSpectrum(1));
  EXPECT_EQ(through->pdf, Float(0.25));
  const auto met = sample(leaf, kWo, {Float(0.7), {Float(0.4), Float(0.4)}}, kAt);
  ASSERT_TRUE(met && !met->passes);
  EXPECT_NEAR(met->weight[0], 0.8, 1e-6);
  EXPECT_NEAR(
      evaluate(leaf, kWo, kWi, kAt).value_cos[0] / evaluate(grey(Float(0.8)), kWo, kWi, kAt).value_cos[0],
      0.75, 1e-6);
  EXPECT_EQ(pass_through(leaf, true, kAt), Float(0.25));
  // Holes in a half: a quarter of a half; through one side of two.
  EXPECT_EQ(pass_through(Mix(nest(grey(1)), nest(leaf), Float(0.5)), false, kAt), Float(0.125));
  EXPECT_EQ(pass_through(TwoSided(nest(grey(1)), nest(leaf)), false, kAt), Float(0.25));
  EXPECT_EQ(pass_through(TwoSided(nest(grey(1)), nest(leaf)), true, kAt), 0);
  EXPECT_EQ(pass_through(Masked(nest(leaf), Float(0.5)), true, kAt), Float(0.625));
  EXPECT_EQ(pass_through(Material(Dielectric{}), true, kAt), 0);
  EXPECT_TRUE(has_holes(NormalMapped(nest(leaf), {})));
  EXPECT_FALSE(has_holes(brushed()));
}

TEST(Nested, OpaqueAndEmptyMasksAreExact) {
  for (const Float u : {Float(0), Float(0.5), kOneMinusEpsilon, Float(1)}) {
    const auto opaque = sample(Masked(nest(grey(1)), Float(1)), kWo, {u, {Float(0.3), Float(0.3)}}, kAt);
    const auto empty = sample(Masked(nest(grey(1)), Float(0)), kWo, {u, {Float(0.3), Float(0.3)}}, kAt);
    ASSERT_TRUE(opaque && empty);
    EXPECT_FALSE(opaque->passes);
    EXPECT_TRUE(empty->passes);
  }
}

TEST(NormalMap, FlatChangesNothing) {
  const Material flat = NormalMapped(nest(brushed()), uniform_normal({0, 0, 1}));
  for (int lane = 0; lane < kLanes; ++lane) {
    EXPECT_NEAR(
        evaluate(flat, kWo, kWi, kAt).value_cos[lane] / evaluate(brushed(), kWo, kWi, kAt).value_cos[lane], 1,
        1e-5);
  }
}

TEST(NormalMap, TurnsTheCosine) {
  const Vec3 n = normalize({Float(0.3), Float(0.1), Float(0.9)});
  const Material bumps = NormalMapped(nest(grey(1)), uniform_normal(n));
  EXPECT_NEAR(evaluate(bumps, kWo, kWi, kAt).value_cos[0], dot(n, kWi) / kPi64, 1e-6);
  // Mirrored texture coordinates: v grows towards -y.
  EXPECT_NEAR(evaluate(bumps, kWo, kWi, {.lambda = kLambda, .v_sign = -1}).value_cos[0],
              dot(Vec3{n.x, -n.y, n.z}, kWi) / kPi64, 1e-6);
  // From behind the same bumps: -n is the normal there.
  EXPECT_NEAR(evaluate(bumps, -kWo, -kWi, kAt).value_cos[0], dot(n, kWi) / kPi64, 1e-6);
}

TEST(NormalMap, NoLightLeaks) {
  const Vec3 n = normalize({Float(0.9), 0, Float(0.5)});
  const Material bumps = NormalMapped(nest(grey(1)), uniform_normal(n));
  const Vec3 under_surface = normalize({Float(0.9), 0, Float(-0.1)});  // above the bent horizon
  const Vec3 under_bent = normalize({Float(-0.9), 0, Float(0.1)});     // above the surface
  EXPECT_GT(dot(n, under_surface), 0);
  EXPECT_LT(dot(n, under_bent), 0);
  const Vec3 wo{0, 0, 1};
  EXPECT_TRUE(evaluate(bumps, wo, under_surface, kAt).value_cos.is_zero());
  EXPECT_TRUE(evaluate(bumps, wo, under_bent, kAt).value_cos.is_zero());
  // Seen from there the normal bends towards the viewer: not black.
  EXPECT_FALSE(evaluate(bumps, under_bent, {0, 0, 1}, kAt).value_cos.is_zero());
  for (int i = 0; i < 100; ++i) {
    const auto s = sample(bumps, under_bent, {0, {Float(i) / 100, Float(0.7)}}, kAt);
    if (s) {
      EXPECT_GT(s->wi.z, 0);
    }
  }
}

TEST(NormalMap, GlassStaysGlass) {
  const Material glass =
      NormalMapped(nest(Dielectric{}), uniform_normal(normalize({Float(0.1), 0, Float(0.9)})));
  EXPECT_TRUE(is_delta(glass));
  EXPECT_TRUE(is_transmissive(glass));
  const auto s = sample(glass, kWo, {kOneMinusEpsilon, {}}, kAt);
  ASSERT_TRUE(s);
  EXPECT_LT(s->wi.z, 0);
}

}  // namespace
}  // namespace spectrace
