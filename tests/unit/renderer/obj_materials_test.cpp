// SPDX-License-Identifier: Apache-2.0
// Meshes that bring materials along: the statements of a library, what they mean, and how a file is split.
#include "renderer/obj_materials.h"

#include <gtest/gtest.h>

#include <fstream>

#include "core/base/error.h"
#include "core/image/image.h"
#include "core/spectra/rgb_uplift.h"
#include "renderer/obj_file.h"
#include "tests/support/render_scenes.h"
#include "tests/support/temporary_folder.h"

namespace spectrace::test {
namespace {

class ObjMaterials : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }
  MtlMaterial one(const std::string& statements) {
    const auto all = read_mtl(write("one.mtl", "newmtl one\n" + statements + "\n"));
    EXPECT_EQ(all.size(), 1U);
    return all.at(0);
  }
  std::vector<std::string> problems(const std::string& text) {
    const auto file = write("bad.mtl", text);
    std::vector<std::string> found;
    try {
      (void)read_mtl(file);
    } catch (const InputError& e) {
      for (const Diagnostic& d : e.diagnostics()) {
        EXPECT_EQ(d.file, file.string());
        found.push_back(d.where + ": " + d.problem);
      }
    }
    return found;
  }

  TemporaryFolder temporary_;
  std::filesystem::path folder_ = temporary_.path();
};

TEST_F(ObjMaterials, LibrariesAreReadAsTheyAreWritten) {
  const auto all = read_mtl(
      write("two.mtl",
            "# a comment\nnewmtl red paint \r\nKd 0.5 0.25 0.125\nKs .5\n  Ns 30\nillum 2\nKa 1 1 1\n"
            "map_Bump bumps.png\nsharpness 60\nmap_Bump x\n\nnewmtl lamp\nKe 3 4 5\nTr 0.25\nd 0.5\nTr 0.1\n"
            "Pr 0.5\nPm 1\nNi 1.5\nKd spectral x.rfl\n"));
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all[0].name, "red paint");
  EXPECT_EQ(all[0].diffuse, (Rgb{0.5, 0.25, 0.125}));
  EXPECT_EQ(all[0].specular, (Rgb{0.5, 0.5, 0.5}));
  EXPECT_EQ(all[0].exponent, 30);
  EXPECT_FALSE(all[0].emission || all[0].roughness || all[0].opacity);
  EXPECT_EQ(all[0].without_effect, (std::vector<std::string>{"map_Bump", "sharpness"}));
  EXPECT_EQ(all[1].emission, (Rgb{3, 4, 5}));
  EXPECT_EQ(all[1].opacity, 0.5);  // d is the standard's, whichever stands first
  EXPECT_EQ(all[1].roughness, 0.5);
  EXPECT_EQ(all[1].metallic, 1);
  EXPECT_EQ(all[1].refractive_index, 1.5);
  EXPECT_EQ(all[1].without_effect, std::vector<std::string>{"Kd"});
  EXPECT_EQ(one("Tr 0.25").opacity, 0.75);
}

TEST_F(ObjMaterials, EveryWrongLineIsNamed) {
  EXPECT_EQ(problems("Kd 1 1 1\n"), std::vector<std::string>{"line 1: \"Kd\" before the first newmtl"});
  EXPECT_EQ(
      problems("newmtl a\nKd 1 2 1\nKs 0.5 x 1\nKd 1 1\nKd 1 1 1 1\nKe -1 0 0\nNs nan\nPr 1.5\nd\nNi 0\n"
               "map_Kd no.png\n"),
      (std::vector<std::string>{
          "line 2: Kd: expected three numbers in [0, 1]", "line 3: Ks: expected three numbers in [0, 1]",
          "line 4: Kd: expected three numbers in [0, 1]", "line 5: Kd: expected three numbers in [0, 1]",
          "line 6: Ke: expected three numbers >= 0", "line 7: Ns: expected a number >= 0",
          "line 8: Pr: expected a number in [0, 1]", "line 9: d: expected a number in [0, 1]",
          "line 10: Ni: expected a number > 0",
          "line 11: map_Kd: there is no file \"" + (folder_ / "no.png").string() + "\""}));
}

TEST_F(ObjMaterials, NoDamageGoesFurtherThanAMessage) {
  const std::string text =
      "newmtl a\nKd 0.5 0.25 1\nmap_Kd -s 1 1 1 one.mtl\nTr 0.5\nd -halo 1\nillum 7\nNi 1.5\n";
  write("one.mtl", "");
  for (std::size_t i = 0; i < text.size(); ++i) {
    for (char by : {' ', '\n', '\0', '-', '9', '\xff'}) {
      std::string damaged = text;
      damaged[i] = by;
      try {
        (void)read_mtl(write("damaged.mtl", damaged));
      } catch (const InputError&) {  // said so: all that is asked for
      }
    }
  }
}

TEST_F(ObjMaterials, StatementsBecomeMaterials) {
  EXPECT_TRUE(std::holds_alternative<Lambert>(to_material(one("Kd 0.5 0.5 0.5")).kind));
  EXPECT_TRUE(std::holds_alternative<Lambert>(to_material(one("Kd 1 0 0\nKs 0 0 0\nNs 3")).kind));
  EXPECT_TRUE(std::holds_alternative<Lambert>(to_material(one("Kd 1 0 0\nKs 1 1 1\nillum 1")).kind));
  EXPECT_TRUE(std::holds_alternative<Dielectric>(to_material(one("Kd 1 1 1\nNi 1.5\nd 0.1\nillum 7")).kind));
  EXPECT_TRUE(std::holds_alternative<PlasticDesc>(to_material(one("Kd 1 0 0\nPr 0.5")).kind));
  EXPECT_EQ(std::get<PlasticDesc>(to_material(one("Kd 1 0 0\nPr 0.5")).kind).alpha, Float(0.25));
  EXPECT_TRUE(std::holds_alternative<Glossy>(to_material(one("Kd 1 0.7 0.1\nPr 0.2\nPm 1")).kind));
  EXPECT_TRUE(std::holds_alternative<MixDesc>(to_material(one("Kd 1 0.7 0.1\nPr 0.2\nPm 0.5")).kind));
  EXPECT_TRUE(std::holds_alternative<MaskedDesc>(to_material(one("Kd 1 1 1\nd 0.5")).kind));
  EXPECT_TRUE(std::holds_alternative<Lambert>(to_material(one("Kd 1 1 1\nd 1")).kind));
  EXPECT_FALSE(to_emission(one("Kd 1 1 1\nKe 0 0 0")));
  const auto emission = to_emission(one("Ke 2 2 2"));
  ASSERT_TRUE(emission);
  EXPECT_NEAR(spectrum_to_xyz(*emission)[1], 2, 1e-3);  // D65 with that luminance
}

TEST_F(ObjMaterials, KdAndKsAreReflectancesThatAdd) {
  const auto lobes = [&](const std::string& statements) {
    const auto material = std::get<Glossy>(to_material(one(statements)).kind);
    const SampledWavelengths lambda = WavelengthDistribution::uniform({}).sample(Float(0.3));
    const Float f0 = std::get<SchlickFresnel>(material.fresnel).reflectance(1, lambda)[0];
    const Float kd = material.reflectance.sample(lambda, {})[0];
    return std::pair(double(kd * material.diffuse_scale), double(f0 * material.specular_scale));
  };
  // 2e-3: what a grey's uplift is off.
  EXPECT_NEAR(lobes("Kd 0.5 0.5 0.5\nKs 0.25 0.25 0.25\nNs 10").first, 0.5, 2e-3);
  EXPECT_NEAR(lobes("Kd 0.5 0.5 0.5\nKs 0.25 0.25 0.25\nNs 10").second, 0.25, 2e-3);
  EXPECT_NEAR(lobes("Kd 1 1 1\nKs 1 1 1\nNs 10").first, 0.5, 2e-3);  // no more than there is
  EXPECT_NEAR(lobes("Kd 1 1 1\nKs 1 1 1\nNs 10").second, 0.5, 2e-3);
  EXPECT_NEAR(lobes("Kd 0 0 0\nKs 0.25 0.25 0.25\nNs 10").second, 0.25, 2e-3);
  // Scaled down a colour stays what it is.
  const auto red = std::get<Glossy>(to_material(one("Kd 1 0.25 0.25\nKs 1 1 1\nNs 10")).kind);
  const SigmoidSpectrum colour = uplift_reflectance({1, 0.25, 0.25});
  const SampledWavelengths lambda = WavelengthDistribution::uniform({}).sample(Float(0.3));
  for (int i = 0; i < kLanes; ++i) {
    EXPECT_NEAR(red.reflectance.sample(lambda, {})[i], colour.at(lambda.lambda_nm(i)), 1e-6);
  }
  const auto glossy = std::get<Glossy>(to_material(one("Kd 1 1 1\nKs 1 1 1\nNs 198")).kind);
  EXPECT_NEAR(glossy.ggx.alpha_x, 0.1, 1e-6);
}

const std::string kSquares =
    "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\nvt 0 0\nusemtl red\nf 1 2 3\nusemtl "
    "blue\n"
    "f 2 5 6 3\no second\nusemtl red\nf 1 3 4\n";

TEST_F(ObjMaterials, FilesAreSplitByMaterial) {
  const ObjGroups split = read_obj_groups(write("squares.obj", kSquares));
  ASSERT_EQ(split.groups.size(), 2U);
  EXPECT_EQ(split.groups[0].material, "red");
  EXPECT_EQ(split.groups[0].mesh.triangles.size(), 2U);
  EXPECT_EQ(split.groups[0].mesh.positions.size(), 4U);  // its own vertices only
  EXPECT_EQ(split.groups[1].material, "blue");
  EXPECT_EQ(split.groups[1].mesh.triangles.size(), 2U);
  EXPECT_EQ(split.libraries, std::vector<std::filesystem::path>{folder_ / "a.mtl"});
  // Without a library, with faces before the first usemtl, with blanks in names.
  const ObjGroups bare =
      read_obj_groups(write("bare.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\nusemtl light blue\nf 3 2 1\n"));
  ASSERT_EQ(bare.groups.size(), 2U);
  EXPECT_EQ(bare.groups[0].material, "");
  EXPECT_EQ(bare.groups[1].material, "light blue");
  EXPECT_TRUE(bare.libraries.empty());
  EXPECT_THROW((void)read_obj_groups(write("bad.obj", "v 0 0 0\nv 1 0 0\nusemtl x\nf 1 2 9\n")), InputError);
  EXPECT_THROW((void)read_obj_groups(write(
                   "twins.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nusemtl a b\nf 1 2 3\nusemtl a c\nf 1 3 2\n")),
               InputError);
}

struct Notes final : Progress {
  void update(std::string_view, double, double) override {}
  void note(std::string_view text) override { notes.emplace_back(text); }
  std::vector<std::string> notes;
};

SceneDesc scene_of(const std::filesystem::path& file, std::map<std::string, std::string> mapping) {
  SceneDesc scene = empty_scene();
  scene.materials = {lambert("grey", Float(0.5))};
  scene.shapes = {{.where = "/shapes/0", .kind = MeshDesc{.file = file, .materials = std::move(mapping)}}};
  return scene;
}

std::string problem_of(const SceneDesc& scene) {
  SilentProgress progress;
  try {
    (void)build_scene(scene, progress);
  } catch (const InputError& e) {
    return e.diagnostics().front().problem;
  }
  return "";
}

TEST_F(ObjMaterials, ScenesTakeThemFromTheLibraryOrTheScene) {
  const auto obj = write("squares.obj", kSquares);
  write("a.mtl", "newmtl red\nKd 1 0 0\nmap_Bump x.png\nnewmtl blue\nKd 0 0 1\nKe 1 1 1\n");
  Notes notes;
  const Scene both = build_scene(scene_of(obj, {}), notes);
  ASSERT_EQ(both.geometry.shapes.size(), 2U);
  EXPECT_EQ(both.materials.size(), 3U);
  EXPECT_EQ(both.geometry.shapes[0].material, 1U);
  EXPECT_EQ(both.geometry.shapes[1].material, 2U);
  EXPECT_EQ(both.lights.area_count(), 2U);  // blue's two triangles
  ASSERT_EQ(notes.notes.size(), 1U);
  EXPECT_EQ(notes.notes[0], (folder_ / "a.mtl").string() + ": red: without effect: map_Bump");

  const Scene mapped = build_scene(scene_of(obj, {{"blue", "grey"}}), notes);
  EXPECT_EQ(mapped.materials.size(), 2U);
  EXPECT_EQ(mapped.geometry.shapes[1].material, 0U);
  EXPECT_EQ(mapped.lights.area_count(), 0U);

  SceneDesc twice = scene_of(obj, {});
  twice.shapes.push_back(twice.shapes[0]);
  EXPECT_EQ(build_scene(twice, notes).materials.size(), 3U);  // made once
}

TEST_F(ObjMaterials, WhatIsMissingIsSaid) {
  const auto obj = write("squares.obj", kSquares);
  EXPECT_EQ(problem_of(scene_of(obj, {})),
            "names the material library \"" + (folder_ / "a.mtl").string() +
                "\", which is not there; a shape's \"materials\" may name one of the scene for it");
  EXPECT_EQ(problem_of(scene_of(obj, {{"red", "grey"}, {"blue", "grey"}})), "");  // then it is not needed
  write("a.mtl", "newmtl red\nKd 1 0 0\nnewmtl bleu\nKd 0 0 1\n");
  EXPECT_EQ(problem_of(scene_of(obj, {})),
            "uses the material \"blue\", which its library does not have; did you mean \"bleu\"?; a shape's "
            "\"materials\" may name one of the scene for it");
  EXPECT_EQ(problem_of(scene_of(obj, {{"blu", "grey"}, {"blue", "grey"}})),
            "\"materials\" has \"blu\", which no face of " + obj.string() + " uses; did you mean \"blue\"?");
  const auto bare = write("bare.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\nusemtl x\nf 3 2 1\n");
  EXPECT_EQ(problem_of(scene_of(bare, {{"x", "grey"}})),
            bare.string() + " has faces before its first usemtl: give a \"material\" for them");
  SceneDesc with_default = scene_of(bare, {});
  with_default.shapes[0].material = "grey";
  EXPECT_EQ(problem_of(with_default),
            "uses the material \"x\" and names no library that could have it; a shape's "
            "\"materials\" may name one of the scene for it");
}

TEST_F(ObjMaterials, ALibrarysColourIsThatOfTheScene) {
  const auto obj = write("squares.obj", kSquares);
  write("a.mtl", "newmtl red\nKd 0.8 0.2 0.1\nnewmtl blue\nmap_Kd blue.png\n");
  Image blue(2, 2, {"R", "G", "B"});
  for (int i = 0; i < 4; ++i) blue.at(i % 2, i / 2, 2) = 0.5F;
  write_png(folder_ / "blue.png", blue);
  const auto picture = [&](const std::map<std::string, std::string>& mapping) {
    SceneDesc scene = scene_of(obj, mapping);
    scene.camera = {
        .origin = {1, Float(0.5), 4}, .target = {1, Float(0.5), 0}, .up = {0, 1, 0}, .fov_deg = 40};
    scene.materials = {lambert("red", Spectrum(uplift_reflectance({0.8, 0.2, 0.1}))),
                       {.name = "blue",
                        .where = "",
                        .kind = Lambert{Texture(BitmapTexture(read_image(folder_ / "blue.png")))}}};
    scene.lights = {sky(1)};
    return render_scene(scene, 16).image;
  };
  const Image brought = picture({});
  EXPECT_EQ(brought.data, picture({{"red", "red"}, {"blue", "blue"}}).data);
  EXPECT_GT(brought.at(2, 4, 0), 2 * brought.at(2, 4, 2));  // red to the left
  EXPECT_GT(brought.at(5, 4, 2), 2 * brought.at(5, 4, 0));  // blue to the right
}

}  // namespace
}  // namespace spectrace::test
