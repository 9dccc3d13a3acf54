// SPDX-License-Identifier: Apache-2.0
#include "renderer/features.h"

#include <gtest/gtest.h>

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

TEST(Features, EveryEffectIsListedOnceWithItsReason) {
  const EffectList list = list_effects(features_of("box"), choose_kernel(features_of("box")).features);
  EXPECT_EQ(list.used.size() + list.skipped.size(), kFeatureInfos.size());
  EXPECT_EQ(list.used, (std::vector<std::string>{"indirect light", "area lights", "layers by lobe"}));
  EXPECT_EQ(list.skipped[0], "point, spot and directional lights: none in the scene");
}

}  // namespace
}  // namespace spectrace::test
