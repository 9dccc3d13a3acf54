// SPDX-License-Identifier: Apache-2.0
#include "renderer/features.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "core/base/error.h"
#include "renderer/kernels.h"
#include "tests/support/render_scenes.h"
#include "tests/support/scene_zoo.h"

namespace spectrace::test {
namespace {

Features features_of(const std::string& name) {
  for (const NamedScene& entry : scene_zoo()) {
    if (entry.name == name) {
      SilentProgress progress;
      return required_features(build_scene(entry.scene, progress), kLobeAovs);
    }
  }
  ADD_FAILURE() << "no scene " << name;
  return {};
}

TEST(Features, AreWhatTheSceneCallsFor) {
  EXPECT_EQ(features_of("empty"), (Features{.indirect = true, .lobe_layers = true}));
  EXPECT_EQ(features_of("empty under a sky"),
            (Features{.indirect = true, .environment = true, .lobe_layers = true}));
  EXPECT_EQ(features_of("box"), (Features{.indirect = true, .area_lights = true, .lobe_layers = true}));
  EXPECT_EQ(features_of("box, direct light only"), (Features{.area_lights = true, .lobe_layers = true}));
  EXPECT_EQ(features_of("glossy ball, checkered floor, delta lights"),
            (Features{.indirect = true, .delta_lights = true, .textures = true, .lobe_layers = true}));
  EXPECT_EQ(features_of("glass"), (Features{.indirect = true,
                                            .area_lights = true,
                                            .environment = true,
                                            .delta_lobes = true,
                                            .transmission = true,
                                            .lobe_layers = true}));
  EXPECT_TRUE(features_of("dispersing glass").dispersion);
  EXPECT_TRUE(features_of("instances").instances);
  EXPECT_FALSE(features_of("mirror").transmission);
}

TEST(Features, MaterialsNoShapeUsesCallForNothing) {
  SceneDesc scene = empty_scene();
  scene.materials = {{.name = "glass", .where = "", .kind = Dielectric{}}};
  SilentProgress progress;
  EXPECT_FALSE(required_features(build_scene(scene, progress), kLobeAovs).delta_lobes);
}

TEST(Kernels, RunFromLeanToFullAndEachIsChosenForItself) {
  ASSERT_FALSE(kernels().empty());
  EXPECT_EQ(kernels().back().features, all_features());
  for (const Kernel& kernel : kernels()) {
    EXPECT_EQ(choose_kernel(kernel.features).name, kernel.name);  // none shadows another
  }
}

TEST(Kernels, TheLeanestIsChosen) {
  EXPECT_EQ(choose_kernel(features_of("box")).name, "box");
  EXPECT_EQ(choose_kernel(features_of("box, direct light only")).name, "direct");
  EXPECT_EQ(choose_kernel(features_of("diffuse ball")).name, "studio");
  EXPECT_EQ(choose_kernel(features_of("instances")).name, "opaque");
  EXPECT_EQ(choose_kernel(features_of("glass")).name, "full");
}

Scene zoo_scene(const std::string& name) {
  SilentProgress progress;
  for (const NamedScene& entry : scene_zoo()) {
    if (entry.name == name) return build_scene(entry.scene, progress);
  }
  throw InternalError("no scene " + name);
}

/// Thin film, diffraction effect, residual: no flag is for them.
constexpr std::size_t kOfMaterialsAlone = 3;

EffectList effects_of(const std::string& name, const Features& forced = {}) {
  const Scene scene = zoo_scene(name);
  const Features needed = united(required_features(scene, kLobeAovs), forced);
  return list_effects(scene, kLobeAovs, forced, choose_kernel(needed).features);
}

TEST(Features, EveryEffectIsListedOnceWithItsReason) {
  const EffectList list = effects_of("box");
  EXPECT_EQ(list.used.size() + list.skipped.size(), kFeatureInfos.size() + kOfMaterialsAlone);
  EXPECT_EQ(list.used, (std::vector<std::string>{"indirect light: max_depth is above 1",
                                                 "area lights: a shape emits", "layers by lobe: asked for"}));
  EXPECT_EQ(list.skipped[0], "point, spot and directional lights: none in the scene");
}

TEST(Features, TheMaterialThatCallsForAnEffectIsNamed) {
  const EffectList list = effects_of("dispersing glass");
  const std::string start = "dispersion: refraction varies with wavelength, by the material \"";
  EXPECT_TRUE(std::any_of(list.used.begin(), list.used.end(), [&](const std::string& effect) {
    return effect.starts_with(start) && effect.size() > start.size() + 1;
  }));
}

TEST(Features, WhatIsPartOfAMaterialIsListedToo) {
  const auto is_used = [](const EffectList& list, std::string_view start) {
    return std::any_of(list.used.begin(), list.used.end(),
                       [&](const std::string& effect) { return effect.starts_with(start); });
  };
  const EffectList separated = effects_of("separated ball");
  EXPECT_TRUE(is_used(separated,
                      "diffraction effect: a separated material is rendered by a model that has "
                      "it, by the material \""));
  EXPECT_FALSE(is_used(separated, "residual"));
  EXPECT_FALSE(is_used(separated, "thin film"));
  for (const NamedScene& entry : scene_zoo()) {
    if (entry.name != "box") continue;
    SceneDesc scene = entry.scene;
    const ThinFilm film{.eta = Spectrum::constant(Float(1.3)), .thickness_nm = 300};
    for (MaterialDesc& material : scene.materials) material.kind = Dielectric{.film = film};
    SilentProgress progress;
    const Scene built = build_scene(scene, progress);
    EXPECT_TRUE(is_used(list_effects(built, kLobeAovs, {}, all_features()),
                        "thin film: an interface has one, by the material \""));
  }
}

TEST(Features, WhatIsForcedIsSimulatedAndSaysWhy) {
  const EffectList list = effects_of("box", {.instances = true});
  EXPECT_EQ(std::count(list.used.begin(), list.used.end(), "instances: none in the scene (forced)"), 1);
  EXPECT_EQ(list.used.size() + list.skipped.size(), kFeatureInfos.size() + kOfMaterialsAlone);
}

}  // namespace
}  // namespace spectrace::test
