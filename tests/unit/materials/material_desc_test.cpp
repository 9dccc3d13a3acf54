// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

#include "materials/material.h"
#include "materials/refractive_index.h"
#include "tests/support/test_data.h"

namespace spectrace {
namespace {

MaterialDesc parse(const std::string& text) {
  JsonDocument document = JsonDocument::parse(text, "m.json");
  MaterialDesc material = parse_material(document.root());
  document.throw_if_wrong();
  return material;
}

/// The diagnostics of a wrong material, one a line.
std::string problems(const std::string& text) {
  try {
    parse(text);
  } catch (const InputError& e) {
    std::string all;
    for (const Diagnostic& d : e.diagnostics()) all += d.text() + "\n";
    return all;
  }
  return "";
}

void expect_problem(const std::string& text, const std::string& part) {
  const std::string found = problems(text);
  EXPECT_NE(found.find(part), std::string::npos) << text << "\ngave: " << found;
  EXPECT_EQ(std::count(found.begin(), found.end(), '\n'), 1) << text << "\ngave: " << found;
}

TEST(MaterialDesc, ReadsEveryType) {
  EXPECT_TRUE(
      std::holds_alternative<Lambert>(parse(R"({"name": "a", "type": "lambert", "reflectance": 0.5})").kind));
  EXPECT_TRUE(std::holds_alternative<SmoothConductor>(
      parse(R"({"name": "a", "type": "conductor", "eta": 0.2, "k": 3})").kind));
  EXPECT_TRUE(std::holds_alternative<SmoothConductor>(
      parse(R"({"name": "a", "type": "conductor", "eta": 0.2, "k": 3, "roughness": 0})").kind));
  EXPECT_TRUE(
      std::holds_alternative<Dielectric>(parse(R"({"name": "a", "type": "dielectric", "eta": 1.5})").kind));
  EXPECT_EQ(std::get<MeasuredDesc>(
                parse(R"({"name": "a", "type": "measured", "file": "x.bsdf", "albedo": "scale"})").kind)
                .albedo,
            AlbedoLimit::kScale);
  EXPECT_EQ(std::get<MeasuredDesc>(parse(R"({"name": "a", "type": "measured", "file": "x.bsdf"})").kind)
                .file.filename(),
            "x.bsdf");
  const auto separated = std::get<SeparatedDesc>(
      parse(R"({"name": "a", "type": "separated", "file": "x.sep", "model": "fresnel"})").kind);
  EXPECT_EQ(separated.model, SeparationModel::kFresnel);
  const auto chosen = std::get<SeparatedDesc>(
      parse(R"({"name": "a", "type": "separated", "file": "x.sep", "model": "auto", "tolerance": 0.02})")
          .kind);
  EXPECT_EQ(chosen.model, std::nullopt);
  EXPECT_EQ(chosen.tolerance, 0.02);
  expect_problem(R"({"name": "a", "type": "separated", "file": "x.sep", "tolerance": 0.02})",
                 "only the model \"auto\" has one");
}

TEST(MaterialDesc, ReadsRoughGlass) {
  const auto rough = std::get<RoughDielectric>(
      parse(R"({"name": "a", "type": "dielectric", "eta": 1.5, "roughness": [0.1, 0.4]})").kind);
  EXPECT_EQ(rough.eta().at(500), Float(1.5));
  EXPECT_EQ(rough.ggx().alpha_y, Float(0.4));
  EXPECT_TRUE(std::holds_alternative<Dielectric>(
      parse(R"({"name": "a", "type": "dielectric", "eta": 1.5, "roughness": 0})").kind));
  expect_problem(R"({"name": "a", "type": "dielectric", "eta": 1.005, "roughness": 0.1})", "away from 1");
  expect_problem(
      R"({"name": "a", "type": "dielectric", "eta": {"wavelengths_nm": [400, 700], "values": [0.9, 1.1]}, "roughness": 0.1})",
      "away from 1");
  EXPECT_EQ(problems(R"({"name": "a", "type": "dielectric", "eta": 0.75, "roughness": 0.1})"), "");
}

TEST(MaterialDesc, ReadsPlastic) {
  const std::string head = R"({"name": "a", "type": "plastic", "reflectance": 0.5, )";
  EXPECT_EQ(std::get<PlasticDesc>(parse(head + R"("eta": 1.5, "roughness": 0.2})").kind).alpha, Float(0.2));
  EXPECT_TRUE(has_delta_lobe(build_material(parse(head + R"("eta": 1.5})"))));
  EXPECT_FALSE(has_delta_lobe(build_material(parse(head + R"("eta": 1.5, "roughness": 1})"))));
  expect_problem(head + R"("eta": 0.9})", "must be in [1, 4]");
  expect_problem(head + R"("eta": 5})", "must be in [1, 4]");
  expect_problem(head + R"("eta": 1.5, "roughness": [0.1, 0.2]})", "/roughness");
  expect_problem(head + R"("roughness": 0.1})", "eta");
}

TEST(MaterialDesc, ReadsDiffractiveMaterials) {
  const std::string head = R"({"name": "a", "type": "diffractive", "f0": 0.9, "roughness": 0.1, )";
  const auto bare = std::get<Diffractive>(
      parse(head + R"("micro_roughness": {"rms_nm": 40, "correlation_nm": 2000}})").kind);
  EXPECT_EQ(bare.micro.rms_nm, 40);
  EXPECT_EQ(bare.micro.correlation_nm, 2000);
  EXPECT_EQ(bare.micro.exponent, 3);
  EXPECT_EQ(bare.specular_scale, 1);
  EXPECT_EQ(bare.diffuse_scale, 0);
  expect_problem(head + R"("micro_roughness": {"rms_nm": 40}})", "correlation_nm");
  expect_problem(head + R"("micro_roughness": {"rms_nm": -1, "correlation_nm": 2000}})", "rms_nm");
  expect_problem(head + R"("micro_roughness": {"rms_nm": 40, "correlation_nm": 2000, "exponent": 2}})",
                 "exponent");
  expect_problem(head + R"("micro_roughness": {"rms_nm": 40, "correlation_nm": 2000}, "diffuse_scale": 0.1})",
                 "must be at most 1");
}

TEST(MaterialDesc, RoughnessIsAlphaItself) {
  const auto rough = std::get<RoughConductor>(
      parse(R"({"name": "a", "type": "conductor", "eta": 0.2, "k": 3, "roughness": 0.3})").kind);
  EXPECT_EQ(rough.ggx.alpha_x, Float(0.3));
  EXPECT_EQ(rough.ggx.alpha_y, Float(0.3));
  const auto brushed = std::get<RoughConductor>(
      parse(R"({"name": "a", "type": "conductor", "eta": 0.2, "k": 3, "roughness": [0.1, 0.4]})").kind);
  EXPECT_EQ(brushed.ggx.alpha_x, Float(0.1));
  EXPECT_EQ(brushed.ggx.alpha_y, Float(0.4));
}

TEST(MaterialDesc, GlossySharesTheSurfaceBetweenItsLobes) {
  const auto glossy = std::get<Glossy>(
      parse(
          R"({"name": "a", "type": "glossy", "reflectance": 0.5, "f0": 0.04, "roughness": 0.3, "specular_scale": 0.25})")
          .kind);
  EXPECT_EQ(glossy.specular_scale, Float(0.25));
  EXPECT_EQ(glossy.diffuse_scale, Float(0.75));
}

TEST(MaterialDesc, KnowsMetalsByName) {
  const auto gold = std::get<RoughConductor>(
      parse(R"({"name": "a", "type": "conductor", "metal": "Au", "roughness": 0.2})").kind);
  const auto file = std::get<RoughConductor>(
      load_material(std::filesystem::path(SPECTRACE_SOURCE_DIR) / "scenes/materials/gold.json").kind);
  for (const Float nm : {Float(400), Float(555), Float(700)}) {
    EXPECT_NEAR(gold.fresnel.eta.at(nm), file.fresnel.eta.at(nm), 1e-5);
    EXPECT_NEAR(gold.fresnel.k.at(nm), file.fresnel.k.at(nm), 1e-5);
  }
  expect_problem(R"({"name": "a", "type": "conductor", "metal": "gold"})", "Au");
  expect_problem(R"({"name": "a", "type": "conductor", "metal": "Au", "eta": 1.5})", "already gives");
  expect_problem(R"({"name": "a", "type": "conductor", "metal": "Au", "metal_file": "x.yml"})",
                 "already gives");
  expect_problem(
      R"({"name": "a", "type": "glossy", "reflectance": 0.5, "f0": 0.04, "metal": "Au", "roughness": 0.3})",
      "exclude each other");
}

TEST(MaterialDesc, ReadsMaterialsMadeOfOthers) {
  const std::string grey = R"({"type": "lambert", "reflectance": 0.5})";
  const auto mix = parse(R"({"name": "a", "type": "mix", "weight": 0.25, "first": )" + grey +
                         R"(, "second": {"type": "mask", "opacity": 0.5, "material": )" + grey + "}}");
  const auto& parts = std::get<MixDesc>(mix.kind).parts;
  ASSERT_EQ(parts.size(), 2U);
  EXPECT_TRUE(std::holds_alternative<Lambert>(parts[0].kind));
  EXPECT_EQ(std::get<MaskedDesc>(parts[1].kind).parts.size(), 1U);
  EXPECT_TRUE(has_holes(build_material(mix)));
  EXPECT_FALSE(keeps_sides(build_material(parts[0])));
  EXPECT_TRUE(keeps_sides(build_material(
      parse(R"({"name": "a", "type": "two_sided", "front": )" + grey + R"(, "back": )" + grey + "}"))));
  expect_problem(
      R"({"name": "a", "type": "mix", "weight": 1.5, "first": )" + grey + R"(, "second": )" + grey + "}",
      "[0, 1]");
  expect_problem(R"({"name": "a", "type": "mix", "first": )" + grey + R"(, "second": )" + grey + "}",
                 "weight");
  expect_problem(R"({"name": "a", "type": "mask", "opacity": 1})", "\"material\"");
  expect_problem(R"({"name": "a", "type": "mask", "opacity": 1, "material": {"type": "lambert"}})",
                 "reflectance");
  expect_problem(R"({"type": "mask", "opacity": 1, "material": )" + grey + "}", "name");
  expect_problem(R"({"name": "a", "type": "normal_map", "normals": "absent.png", "material": )" + grey + "}",
                 "there is no file");
}

TEST(MaterialDesc, NamesEachMistakeOnce) {
  expect_problem(R"({"name": "a", "type": "lambert", "reflectance": 0.5, "roughnes": 1})", "roughnes");
  expect_problem(R"({"name": "a", "type": "lamber", "reflectance": 0.5})", "lambert");
  expect_problem(R"({"name": "a", "reflectance": 0.5})", "type");
  expect_problem(R"({"type": "lambert", "reflectance": 0.5})", "name");
  expect_problem(R"({"name": "a", "type": "conductor", "eta": 0.2})", "\"k\"");
  expect_problem(R"({"name": "a", "type": "conductor", "eta": 0, "k": 1})", "must be > 0 at");
  expect_problem(R"({"name": "a", "type": "conductor", "eta": 1, "k": -1})", "must be >= 0 at");
  expect_problem(R"({"name": "a", "type": "conductor", "eta": 0.2, "k": 3, "roughness": 0.0001})",
                 "/roughness");
  expect_problem(R"({"name": "a", "type": "conductor", "eta": 0.2, "k": 3, "roughness": [0.1, 2]})",
                 "/roughness");
  expect_problem(R"({"name": "a", "type": "conductor", "eta": 0.2, "k": 3, "thin_film": {"eta": 1.5}})",
                 "thickness_nm");
  expect_problem(
      R"({"name": "a", "type": "conductor", "eta": 0.2, "k": 3, "thin_film": {"eta": 0.9, "thickness_nm": 9}})",
      "must be >= 1 at");
  expect_problem(R"({"name": "a", "type": "conductor", "metal_file": "absent.yml"})", "absent.yml");
  expect_problem(
      R"({"name": "a", "type": "glossy", "reflectance": 0.5, "f0": 0.04, "eta": 1.5, "roughness": 0.3})",
      "\"f0\" and \"eta\"");
  expect_problem(
      R"({"name": "a", "type": "glossy", "reflectance": 0.5, "f0": 0.04, "roughness": 0.3, "specular_scale": 0.7, "diffuse_scale": 0.7})",
      "must be at most 1");
  expect_problem(R"({"name": "a", "type": "separated", "file": "x.sep", "model": "frensel"})", "fresnel");
}

TEST(MaterialDesc, BuiltInMaterialsLoad) {
  for (const char* name : {"matte", "glossy", "gold", "pearlescent"}) {
    const std::filesystem::path file =
        std::filesystem::path(SPECTRACE_SOURCE_DIR) / "scenes/materials" / (std::string(name) + ".json");
    EXPECT_EQ(load_material(file).name, name);
    EXPECT_NO_THROW(build_material(load_material(file)));
  }
}

class RefractiveIndexFile : public ::testing::Test {
 protected:
  std::filesystem::path write(const std::string& text) {
    const auto file = std::filesystem::path(::testing::TempDir()) /
                      (std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()) + ".yml");
    std::ofstream(file) << text;
    return file;
  }
  std::string problem(const std::string& text) {
    try {
      read_refractive_index(write(text));
    } catch (const InputError& e) {
      return e.diagnostics().front().where + "|" + e.diagnostics().front().problem;
    }
    return "";
  }
};

constexpr const char* kHead = "DATA:\n  - type: tabulated nk\n    data: |\n";

TEST_F(RefractiveIndexFile, IsReadInNanometres) {
  const RefractiveIndex index = read_refractive_index(
      write(std::string(kHead) + "        0.4 1.5 2\n        0.8 1.7 4\nSPECS:\n    n_is_absolute: true\n"));
  EXPECT_NEAR(index.eta.at(600), 1.6, 1e-6);
  EXPECT_NEAR(index.k.at(600), 3, 1e-6);
  EXPECT_NEAR(index.k.at(900), 4, 1e-6);
}

TEST_F(RefractiveIndexFile, FaultsHaveLineAndColumn) {
  const std::string head(kHead);
  EXPECT_EQ(problem(head + "        0.4 x 2\n").substr(0, 5), "4:13|");
  EXPECT_EQ(problem(head + "        0.4 1.5\n").substr(0, 5), "4:16|");
  EXPECT_EQ(problem(head + "        0.4 1.5 2 3\n").substr(0, 5), "4:19|");
  EXPECT_EQ(problem(head + "        0.4 1.5 2\n        0.4 1.5 2\n").substr(0, 4), "5:9|");
  EXPECT_EQ(problem(head + "        0.4 0 2\n").substr(0, 4), "4:9|");
  EXPECT_NE(problem("DATA:\n  - type: tabulated n\n    data: |\n        0.4 1.5\n").find("tabulated nk"),
            std::string::npos);
  EXPECT_NE(problem("").find("tabulated nk"), std::string::npos);
}

TEST(RefractiveIndex, ReadsTheDatabaseFiles) {
  for (const char* name :
       {"Au_Johnson", "Ag_Johnson", "Al_Rakic", "Cu_Johnson", "Cr_Johnson", "Ti_Johnson"}) {
    const auto file = test::data_folder() / "metals" / (std::string(name) + ".yml");
    SPECTRACE_SKIP_WITHOUT(file);
    const RefractiveIndex index = read_refractive_index(file);
    for (const Float lambda : {Float(400), Float(600), Float(800)}) {
      EXPECT_GT(index.eta.at(lambda), 0) << name;
      EXPECT_GT(index.k.at(lambda), Float(1)) << name << ": metals of the list absorb";
    }
  }
}

}  // namespace
}  // namespace spectrace
