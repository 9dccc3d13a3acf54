// SPDX-License-Identifier: Apache-2.0
// What Cryptomatte tells of rendered scenes.
#include "renderer/matte.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <map>

#include "tests/support/render_scenes.h"
#include "tests/support/scene_zoo.h"

namespace spectrace::test {
namespace {

constexpr AovSet kMatteAovs{.crypto_object = true, .crypto_material = true};

class EverySceneMatte : public testing::TestWithParam<NamedScene> {};

INSTANTIATE_TEST_SUITE_P(Zoo, EverySceneMatte, testing::ValuesIn(scene_zoo()), [](const auto& tested) {
  std::string name = tested.param.name;
  std::erase_if(name, [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; });
  return name;
});

/// Coverage by id of one pixel; ids and coverages as the ranks of `layer` tell them.
std::map<std::uint32_t, double> coverage(const Image& image, int x, int y, const std::string& layer) {
  std::map<std::uint32_t, double> found;
  for (const char* number : {"00.", "01.", "02."}) {
    for (const auto& [id, share] : {std::pair("R", "G"), std::pair("B", "A")}) {
      const auto at = [&](const char* c) {
        return image.at(x, y, image.find_channel(layer + number + c).value());
      };
      if (at(share) > 0) found[std::bit_cast<std::uint32_t>(at(id))] = double(at(share));
    }
  }
  return found;
}
double total(const std::map<std::uint32_t, double>& of_pixel) {
  double sum = 0;
  for (const auto& [id, share] : of_pixel) sum += share;
  return sum;
}

TEST_P(EverySceneMatte, CoversAtMostAPixelByWhatIsInTheScene) {
  const Image image = render_scene(GetParam().scene, {.spp = 16, .aovs = kMatteAovs}).image;
  std::map<std::uint32_t, std::string> materials;
  for (const MaterialDesc& material : GetParam().scene.materials) materials[matte_id(material.name)];
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const auto of_materials = coverage(image, x, y, "crypto_material");
      EXPECT_LE(total(of_materials), 1 + 1e-6);
      EXPECT_NEAR(total(of_materials), total(coverage(image, x, y, "crypto_object")), 1e-6);
      for (const auto& [id, share] : of_materials) EXPECT_TRUE(materials.contains(id)) << id;
    }
  }
}

TEST_P(EverySceneMatte, ThreadsAndOtherAovsChangeNoBit) {
  const auto mattes = [&](int threads, const AovSet& aovs) {
    const Image image = render_scene(GetParam().scene, {.spp = 24, .threads = threads, .aovs = aovs}).image;
    std::vector<std::string> channels = matte_channels(Matte::kObject);
    for (const std::string& name : matte_channels(Matte::kMaterial)) channels.push_back(name);
    return image.select(channels, "render").data;
  };
  const std::vector<float> one = mattes(1, kMatteAovs);
  EXPECT_EQ(mattes(2, kMatteAovs), one);
  EXPECT_EQ(mattes(7, kMatteAovs), one);
  EXPECT_EQ(mattes(2, kAllAovs), one);
}

/// The camera looks at two walls that meet in the middle of its third pixel column, from the left.
SceneDesc two_walls() {
  SceneDesc scene = empty_scene();
  scene.materials = {lambert("red", Float(0.5)), lambert("blue", Float(0.5))};
  scene.shapes = {quad({-9, 0, -9}, {0, 0, 18}, {9, 0, 0}, "red"),
                  quad({0, 0, -9}, {0, 0, 18}, {9, 0, 0}, "blue")};
  scene.shapes[0].name = "left";
  scene.camera.projection = Projection::kOrthographic;
  scene.camera.view_size = 8;
  scene.camera.origin = {Float(1.5), -5, 0};
  scene.camera.target = {Float(1.5), 0, 0};
  scene.lights = {sky(1)};
  return scene;
}

TEST(Mattes, TellWhatCoversHowMuchOfAPixel) {
  const Image image = render_scene(two_walls(), {.spp = 64, .aovs = kMatteAovs}).image;
  const std::uint32_t left = matte_id("left"), right = matte_id("shapes/1");
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < 8; ++x) {
      const auto objects = coverage(image, x, y, "crypto_object");
      EXPECT_EQ(total(objects), 1) << "walls everywhere";
      if (x != 2) {
        EXPECT_EQ(objects, (std::map<std::uint32_t, double>{{x < 2 ? left : right, 1}})) << x;
        continue;
      }
      // 64 samples of a (0, 2) sequence: 32 on either side of the middle.
      EXPECT_EQ(objects, (std::map<std::uint32_t, double>{{left, 0.5}, {right, 0.5}}));
      const auto materials = coverage(image, x, y, "crypto_material");
      EXPECT_EQ(materials,
                (std::map<std::uint32_t, double>{{matte_id("red"), 0.5}, {matte_id("blue"), 0.5}}));
    }
  }
}

TEST(Mattes, AreOfTheFirstSurfaceThatIsNoHole) {
  SceneDesc scene = two_walls();
  scene.materials.push_back(
      {.name = "glass", .where = "/materials/2", .kind = Dielectric{Spectrum::constant(Float(1.5))}});
  scene.shapes.push_back(quad({-9, -1, -9}, {0, 0, 18}, {18, 0, 0}, "glass"));
  const Image glass = render_scene(scene, {.spp = 8, .aovs = kMatteAovs}).image;
  EXPECT_EQ(coverage(glass, 4, 4, "crypto_object"),
            (std::map<std::uint32_t, double>{{matte_id("shapes/2"), 1}}));
  EXPECT_EQ(coverage(glass, 4, 4, "crypto_material"),
            (std::map<std::uint32_t, double>{{matte_id("glass"), 1}}));
}

TEST(Mattes, HolesOfAMaskShowWhatIsBehind) {
  SceneDesc scene = two_walls();
  scene.materials.push_back({.name = "net",
                             .where = "",
                             .kind = MaskedDesc{.parts = {lambert("", Float(0.5))}, .opacity = Float(0.25)}});
  scene.shapes.push_back(quad({-9, -1, -9}, {0, 0, 18}, {18, 0, 0}, "net"));
  double net = 0;
  const Image image = render_scene(scene, {.spp = 64, .aovs = kMatteAovs}).image;
  for (int y = 0; y < 8; ++y) {
    for (int x = 3; x < 8; ++x) {
      auto objects = coverage(image, x, y, "crypto_object");
      EXPECT_EQ(total(objects), 1);
      EXPECT_NEAR(objects[matte_id("shapes/1")] + objects[matte_id("shapes/2")], 1, 1e-6);
      net += objects[matte_id("shapes/2")] / 40;
    }
  }
  // 2560 samples: five standard deviations of a coin of 1/4.
  EXPECT_NEAR(net, 0.25, 5 * std::sqrt(0.25 * 0.75 / 2560));
}

TEST(Mattes, NothingIsSeenOfAnEmptyScene) {
  SceneDesc scene = empty_scene();
  scene.lights = {sky(1)};
  const Image image = render_scene(scene, {.spp = 8, .aovs = kMatteAovs}).image;
  for (const std::string& channel : matte_channels(Matte::kObject)) {
    EXPECT_EQ(image.at(3, 3, image.find_channel(channel).value()), 0);
  }
}

TEST(Mattes, AnInstanceIsOneObjectAndShapesOfOneNameAreOne) {
  SceneDesc scene = two_walls();
  scene.groups = {{"walls", {scene.shapes[0], scene.shapes[1]}}};
  scene.groups[0].shapes[0].name.clear();
  ShapeDesc both{.where = "/shapes/0", .kind = InstanceDesc{"walls"}, .name = "both"};
  const ShapeDesc twins[2] = {scene.shapes[0], scene.shapes[1]};
  scene.shapes = {both};
  const Image instance = render_scene(scene, {.spp = 16, .aovs = kMatteAovs}).image;
  EXPECT_EQ(coverage(instance, 2, 4, "crypto_object"),
            (std::map<std::uint32_t, double>{{matte_id("both"), 1}}));
  EXPECT_EQ(coverage(instance, 2, 4, "crypto_material").size(), 2U);
  scene.shapes = {twins[0], twins[1]};
  scene.shapes[1].name = scene.shapes[0].name;
  const Image named_alike = render_scene(scene, {.spp = 16, .aovs = kMatteAovs}).image;
  EXPECT_EQ(coverage(named_alike, 2, 4, "crypto_object"),
            (std::map<std::uint32_t, double>{{matte_id("left"), 1}}));
}

}  // namespace
}  // namespace spectrace::test
