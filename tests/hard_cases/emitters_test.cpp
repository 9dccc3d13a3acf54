// SPDX-License-Identifier: Apache-2.0
// H18: lights of 1e-20 to 1e20, without area, around the camera, and where no sample can find them.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "core/image/image.h"
#include "tests/support/render_scenes.h"
#include "tests/support/run_program.h"

namespace spectrace::test {
namespace {

TEST(H18_Emitters, ALightAroundTheCameraIsNoHindrance) {
  // The camera inside a lamp sees through the back of it? No: backs are black, and nothing is invalid.
  SceneDesc scene = empty_scene();
  scene.materials = {lambert("black", 0), lambert("grey", Float(0.5))};
  scene.shapes = {emitting(sphere(scene.camera.origin, Float(0.5), "black"), 10),
                  sphere({0, 0, 0}, 1, "grey")};
  const RenderResult result = render_scene(scene, 16);
  EXPECT_EQ(result.report.invalid_samples, 0U);
  EXPECT_EQ(estimate_y(result.image).mean, 0);
}

TEST(H18_Emitters, VeryDimAndVeryBrightLightsStayFinite) {
  for (Float radiance : {Float(1e-20), Float(1e20)}) {
    SceneDesc scene = empty_scene();
    scene.materials = {lambert("black", 0), lambert("grey", Float(0.5))};
    scene.shapes = {emitting(sphere({0, -2, 3}, Float(0.5), "black"), radiance),
                    sphere({0, 0, 0}, 1, "grey")};
    const RenderResult result = render_scene(scene, 16);
    EXPECT_EQ(result.report.invalid_samples, 0U) << radiance;
    const double y = estimate_y(result.image).mean / radiance;
    EXPECT_GT(y, 0.001) << radiance;
    EXPECT_LT(y, 1) << radiance;
  }
}

TEST(H18_Emitters, NoFileHoldsAnInfinity) {
  // A lamp that some pixels see whole, some in part and some not at all: its square is among the variances.
  for (const char* radiance : {"1e-20", "1", "1e20", "1e30"}) {
    SCOPED_TRACE(radiance);
    const TemporaryFolder folder;
    write_text(folder / "scene.json",
               std::string(R"({"camera": {"origin": [0, -4, 1], "target": [0, 0, 0], "up": [0, 0, 1]},
"film": {"width": 24, "height": 24, "spectral": {"bins": 5}}, "sampler": {"spp": 16},
"materials": [{"name": "grey", "type": "lambert", "reflectance": 0.5},
              {"name": "gold", "type": "conductor", "metal": "Au", "roughness": 0.2}],
"shapes": [{"type": "sphere", "material": "gold"},
           {"type": "quad", "corner": [-4, -4, -1], "edge_u": [8, 0, 0], "edge_v": [0, 8, 0], "material": "grey"},
           {"type": "sphere", "center": [0.8, -1, 1], "radius": 0.1, "material": "grey", "emission": )") +
                   radiance + "}]}");
    const ProgramResult result =
        run_spectrace({"scene.json", "-o", "out.exr", "--aovs", "all"}, folder.path());
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_TRUE(result.says(" 0 invalid samples")) << result.output;
    std::size_t images = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
      if (entry.path().extension() != ".exr") continue;
      ++images;
      const Image image = read_image(entry.path());
      for (std::size_t i = 0; i < image.data.size(); ++i) {
        ASSERT_TRUE(std::isfinite(image.data[i]))
            << entry.path() << ' ' << image.channels[i % image.channels.size()];
      }
    }
    EXPECT_EQ(images, 4U);  // the picture, and spectra of all light and of each lobe
  }
}

TEST(H18_Emitters, OneWithoutAreaIsNamed) {
  const TemporaryFolder folder;
  write_text(folder / "line.obj", "v 0 0 3\nv 1 0 3\nv 3 0 3\nf 1 2 3\n");
  const auto render = [&](const std::string& lamp) {
    write_text(folder / "scene.json",
               R"({"camera": {"origin": [0, -4, 1], "target": [0, 0, 0], "up": [0, 0, 1]},
"film": {"width": 8, "height": 8}, "sampler": {"spp": 4},
"materials": [{"name": "grey", "type": "lambert", "reflectance": 0.5}],
"shapes": [{"type": "sphere", "material": "grey"}, {)" +
                   lamp + R"(, "material": "grey", "emission": 5}]})");
    return run_spectrace({"scene.json", "-o", "out.exr"}, folder.path());
  };
  // Where the scene itself is wrong it is refused; where a file is damaged, the rest is rendered.
  const ProgramResult quad =
      render(R"("type": "quad", "corner": [0, 0, 3], "edge_u": [1, 0, 0], "edge_v": [2, 0, 0])");
  EXPECT_EQ(quad.exit_code, 3);
  EXPECT_TRUE(quad.complains("/shapes/1/edge_v: is parallel to edge_u: the quad has no area")) << quad.errors;
  const ProgramResult mesh = render(R"("type": "mesh", "file": "line.obj")");
  EXPECT_EQ(mesh.exit_code, 0) << mesh.errors;
  EXPECT_TRUE(mesh.complains("line.obj: 1 of 1 triangles skipped (1 without area)")) << mesh.errors;
  EXPECT_TRUE(mesh.says(" 0 invalid samples")) << mesh.output;
  const Image image = read_image(folder / "out.exr");
  for (const float x : image.data) EXPECT_EQ(x, 0) << "there is no light";
}

TEST(H18_Emitters, DeltaLightsOnDeltaLobesAreDarkAndValid) {
  // No direction that a mirror or smooth glass takes ever meets a point.
  SceneDesc scene = empty_scene();
  scene.materials = {
      {.name = "mirror",
       .where = "",
       .kind =
           SmoothConductor{{.eta = Spectrum::constant(Float(0.2)), .k = Spectrum::constant(3), .film = {}}}},
      {.name = "glass", .where = "", .kind = Dielectric{Spectrum::constant(Float(1.5))}}};
  scene.shapes = {sphere({-1, 0, 0}, 1, "mirror"), sphere({1, 0, 0}, 1, "glass")};
  scene.lights = {PointLightDesc{{0, -3, 2}, Spectrum::constant(1)},
                  PointLightDesc{scene.camera.origin, Spectrum::constant(1)},
                  DirectionalLightDesc{{0, 1, 0}, Spectrum::constant(1)}};
  const RenderResult result = render_scene(scene, 64);
  EXPECT_EQ(result.report.invalid_samples, 0U);
  EXPECT_EQ(estimate_y(result.image).mean, 0);
}

TEST(H18_Emitters, APointLightOnASurfaceStaysFinite) {
  SceneDesc scene = empty_scene();
  scene.materials = {lambert("grey", Float(0.5))};
  scene.shapes = {quad({-4, 0, -4}, {8, 0, 0}, {0, 0, 8}, "grey"), sphere({0, -1, 0}, 1, "grey")};
  scene.lights = {PointLightDesc{{1, 0, 1}, Spectrum::constant(1)},
                  PointLightDesc{{0, -2, 0}, Spectrum::constant(1)},
                  PointLightDesc{{0, Float(-1e-6), 1}, Spectrum::constant(1)}};
  const RenderResult result = render_scene(scene, 64);
  EXPECT_EQ(result.report.invalid_samples, 0U);
  for (const float x : result.image.data) ASSERT_TRUE(std::isfinite(x));
}

TEST(H18_Emitters, ACameraInsideABodySeesItsInsideAndNothingInvalid) {
  for (const MaterialDesc& material :
       {lambert("body", Float(0.5)),
        MaterialDesc{.name = "body", .where = "", .kind = Dielectric{Spectrum::constant(Float(1.5))}},
        MaterialDesc{.name = "body", .where = "", .kind = SmoothConductor{}}}) {
    SceneDesc scene = empty_scene();
    scene.materials = {material};
    scene.shapes = {sphere(scene.camera.origin, Float(0.5), "body")};
    scene.lights = {sky(1)};
    scene.integrator.max_depth = 64;
    const RenderResult result = render_scene(scene, 64);
    EXPECT_EQ(result.report.invalid_samples, 0U);
    for (const float x : result.image.data) ASSERT_TRUE(std::isfinite(x));
  }
}

}  // namespace
}  // namespace spectrace::test
