// SPDX-License-Identifier: Apache-2.0
#include "renderer/approximations.h"

#include <gtest/gtest.h>

#include <string>

#include "renderer/features.h"
#include "renderer/partial_render.h"
#include "tests/support/render_scenes.h"
#include "tests/support/scene_zoo.h"

namespace spectrace::test {
namespace {

SceneDesc zoo_scene(const std::string& name) {
  for (const NamedScene& entry : scene_zoo()) {
    if (entry.name == name) return entry.scene;
  }
  ADD_FAILURE() << "no scene " << name;
  return {};
}

Scene build(const SceneDesc& scene) {
  SilentProgress progress;
  return build_scene(scene, progress);
}

TEST(Approximations, EachNamedAfterAFeatureTakesThatFeatureAway) {
  int taken = 0;
  for (const Approximation& approximation : approximations()) {
    for (const FeatureInfo& info : kFeatureInfos) {
      if (info.id != approximation.effect) continue;
      for (NamedScene& entry : scene_zoo()) {
        const bool has_it = required_features(build(entry.scene), kLobeAovs).*info.flag;
        const bool is_removed = approximate(entry.scene, approximation.effect);
        EXPECT_TRUE(is_removed || !has_it) << entry.name << ", " << info.id;
        const Scene without = build(entry.scene);
        EXPECT_FALSE(required_features(without, kLobeAovs).*info.flag) << entry.name << ", " << info.id;
        EXPECT_EQ(without.approximations.size(), is_removed ? 1U : 0U);
        taken += has_it ? 1 : 0;
      }
    }
  }
  EXPECT_GT(taken, 20);
}

TEST(Approximations, WhatASceneHasNotIsLeftAsItIs) {
  SceneDesc scene = zoo_scene("box, direct light only");
  for (const char* effect : {"indirect-light", "environment", "delta-lights", "depth-of-field", "dispersion",
                             "thin-film", "textures", "residual", "diffraction"}) {
    EXPECT_FALSE(approximate(scene, effect)) << effect;
  }
  EXPECT_TRUE(scene.approximations.empty());
}

TEST(Approximations, ThinFilmsGoFromEveryMaterialThatHasOne) {
  const ThinFilm film{.eta = Spectrum::constant(Float(1.3)), .thickness_nm = 300};
  SceneDesc scene = empty_scene();
  scene.materials = {
      {.name = "glass", .where = "", .kind = Dielectric{.film = film}},
      {.name = "ground", .where = "", .kind = RoughDielectric(Spectrum::constant(Float(1.5)), {}, film)},
      {.name = "metal", .where = "", .kind = SmoothConductor{.fresnel = {.eta = {}, .k = {}, .film = film}}}};
  ASSERT_TRUE(approximate(scene, "thin-film"));
  EXPECT_FALSE(std::get<Dielectric>(scene.materials[0].kind).film);
  EXPECT_FALSE(std::get<RoughDielectric>(scene.materials[1].kind).film());
  EXPECT_FALSE(std::get<SmoothConductor>(scene.materials[2].kind).fresnel.film);
  EXPECT_FALSE(approximate(scene, "thin-film"));
}

TEST(Approximations, IndicesAreThoseOfTheDLine) {
  const CauchySpectrum cauchy{.a = Float(1.5), .b_um2 = Float(0.01)};
  SceneDesc scene = empty_scene();
  scene.materials = {{.name = "glass", .where = "", .kind = Dielectric{.eta = cauchy}}};
  ASSERT_TRUE(approximate(scene, "dispersion"));
  const Spectrum& eta = std::get<Dielectric>(scene.materials[0].kind).eta;
  EXPECT_TRUE(eta.is_constant());
  EXPECT_NEAR(eta.at(400), 1.5 + 0.01 / (0.58756 * 0.58756), 1e-6);
}

TEST(Approximations, TexturesBecomeTheirMeans) {
  SceneDesc scene = empty_scene();
  const Checkerboard board{Spectrum::constant(Float(0.2)), Spectrum::constant(Float(0.6)), 4, 4};
  scene.materials = {{.name = "floor", .where = "", .kind = Lambert{board}}};
  ASSERT_TRUE(approximate(scene, "textures"));
  const Texture& mean = std::get<Lambert>(scene.materials[0].kind).reflectance;
  EXPECT_FALSE(mean.is_textured());
  EXPECT_NEAR(mean.mean().at(555), 0.4, 1e-6);
}

TEST(Approximations, SeparatedMaterialsAreRenderedByThePoorerModel) {
  SceneDesc scene = empty_scene();
  const auto material = [](std::optional<SeparationModel> model) {
    return MaterialDesc{.name = "m", .where = "", .kind = SeparatedDesc{.file = "m.sep", .model = model}};
  };
  scene.materials = {material({}), material(SeparationModel::kResidual), material(SeparationModel::kSun)};
  const auto model = [&](std::size_t i) { return std::get<SeparatedDesc>(scene.materials[i].kind).model; };
  ASSERT_TRUE(approximate(scene, "residual"));
  EXPECT_EQ(model(0), SeparationModel::kDiffraction);
  EXPECT_EQ(model(1), SeparationModel::kDiffraction);
  ASSERT_TRUE(approximate(scene, "diffraction"));
  EXPECT_EQ(model(1), SeparationModel::kFresnel);
  EXPECT_EQ(model(2), SeparationModel::kSun);
}

TEST(Approximations, AnotherImageIsAnotherIdentity) {
  SceneDesc scene = zoo_scene("box");
  const RenderIdentity exact = identity_of(build(scene), 0);
  ASSERT_TRUE(approximate(scene, "indirect-light"));
  EXPECT_NE(identity_of(build(scene), 0).approximations, exact.approximations);
}

}  // namespace
}  // namespace spectrace::test
