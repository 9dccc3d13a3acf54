// SPDX-License-Identifier: Apache-2.0
// One mesh in every file format there is: the same picture, bit for bit.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "renderer/obj_file.h"
#include "tests/support/ply_writer.h"
#include "tests/support/render_scenes.h"

namespace spectrace::test {
namespace {

const std::filesystem::path kTorus = std::filesystem::path(SPECTRACE_SOURCE_DIR) / "scenes/meshes/torus.obj";

Image picture_of(const std::filesystem::path& file) {
  SceneDesc scene = empty_scene();
  scene.film = {32, 24};
  scene.materials = {{.name = "board",
                      .where = "",
                      .kind = Lambert{Texture(Checkerboard{Spectrum::constant(Float(0.2)),
                                                           Spectrum::constant(Float(0.8)), 16, 8})}},
                     lambert("black", 0)};
  scene.shapes = {{.where = "/shapes/0", .kind = MeshDesc{.file = file}, .material = "board"},
                  emitting(sphere({0, -3, 4}, 1, "black"), 9)};
  return render_scene(scene, 4).image;
}

TEST(MeshFiles, PlyShowsWhatObjShows) {
  const Image obj = picture_of(kTorus);
  EXPECT_GT(estimate_y(obj).mean, 0.01);
  const TriangleMesh mesh = read_obj(kTorus);
  const auto file = std::filesystem::path(testing::TempDir()) / "mesh_files_test.ply";
  for (PlyFormat format : {PlyFormat::kText, PlyFormat::kLittleEndian, PlyFormat::kBigEndian}) {
    std::ofstream(file, std::ios::binary) << ply_text(mesh, format);
    EXPECT_EQ(picture_of(file).data, obj.data) << int(format);
  }
}

}  // namespace
}  // namespace spectrace::test
