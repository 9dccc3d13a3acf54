// SPDX-License-Identifier: Apache-2.0
// Measuring and separating, as a user does.
#include <algorithm>

#include "core/image/image.h"
#include "materials/measured_tables.h"
#include "materials/separated_lookup.h"
#include "tests/cli/program.h"
#include "tests/support/synthetic_measured.h"

namespace spectrace::test {
namespace {

using Separate = Program;

TEST_F(Separate, AcquiresAllWavelengthsOfTheDatabase) {
  const std::string material = (kScenes / "materials/glossy.json").string();
  ASSERT_EQ(run({"acquire", material, "-o", "g.bsdf", "--elevations", "5", "--table", "12"}).exit_code, 0);
  EXPECT_EQ(read_measured(folder_ / "g.bsdf").axis.size(), 195U);
  EXPECT_EQ(run({"inspect", "g.bsdf"}).exit_code, 0);
}

TEST_F(Separate, WritesAMaterialAndReportsOnIt) {
  write_measured("m.bsdf");
  const ProgramResult separated = separate("m.bsdf", "m.sep", {"--report", "m.report.json"});
  ASSERT_EQ(separated.exit_code, 0) << separated.errors;
  EXPECT_TRUE(separated.says("step 1")) << separated.output;
  EXPECT_NE(read_text(folder_ / "m.report.json").find("step1"), std::string::npos);
  EXPECT_EQ(run({"inspect", "m.sep"}).exit_code, 0);
  EXPECT_EQ(richest_model(read_separated_source(folder_ / "m.sep")), SeparationModel::kDiffraction);
}

TEST_F(Separate, TakesTheGridItIsGiven) {
  write_measured("m.bsdf");
  const ProgramResult separated = run({"separate", "m.bsdf", "-o", "m.sep", "--full", "--grid", "12x8x6"});
  ASSERT_EQ(separated.exit_code, 0) << separated.errors;
  const HalfDifferenceGrid grid = read_separated(folder_ / "m.sep").grid;
  EXPECT_EQ(grid.n_theta_h, 12);
  EXPECT_EQ(grid.n_theta_d, 8);
  EXPECT_EQ(grid.n_phi_d, 6);
  EXPECT_TRUE(run({"separate", "--help"}).says("90x90x180")) << "the paper's, by default";
  for (const char* wrong :
       {"12x8", "12x8x6x4", "12,8,6", "12x8x1", "-1x8x6", "9999999999x8x6", "16000x16000x2"}) {
    SCOPED_TRACE(wrong);
    expect_usage_error({"separate", "m.bsdf", "-o", "wrong.sep", "--grid", wrong});
  }
  EXPECT_FALSE(std::filesystem::exists(folder_ / "wrong.sep"));
}

TEST_F(Separate, StoresWhatItIsAskedFor) {
  write_measured("m.bsdf");
  ASSERT_EQ(separate("m.bsdf", "full.sep", {"--full"}).exit_code, 0);
  EXPECT_NO_THROW(read_separated(folder_ / "full.sep"));  // plain tables
  ASSERT_EQ(separate("m.bsdf", "sun.sep", {"--model", "sun"}).exit_code, 0);
  ASSERT_EQ(separate("m.bsdf", "rest.sep", {"--model", "residual", "--analytic"}).exit_code, 0);
  EXPECT_EQ(richest_model(read_separated_source(folder_ / "sun.sep")), SeparationModel::kSun);
  EXPECT_EQ(richest_model(read_separated_source(folder_ / "rest.sep")), SeparationModel::kResidual);
  EXPECT_LT(std::filesystem::file_size(folder_ / "sun.sep"),
            std::filesystem::file_size(folder_ / "rest.sep"));
  const ProgramResult chosen = separate("m.bsdf", "auto.sep", {"--model", "auto", "--tolerance", "1"});
  ASSERT_EQ(chosen.exit_code, 0) << chosen.errors;
  EXPECT_TRUE(chosen.says("sun: error")) << chosen.output;  // anything is within a tolerance of 1
  EXPECT_EQ(richest_model(read_separated_source(folder_ / "auto.sep")), SeparationModel::kSun);
  for (const char* file : {"full.sep", "sun.sep", "rest.sep"})
    EXPECT_EQ(run({"inspect", file}).exit_code, 0) << file;
}

TEST_F(Separate, ASceneMayLeaveTheModelToATolerance) {
  write_measured("m.bsdf");
  ASSERT_EQ(separate("m.bsdf", "rest.sep", {"--model", "residual"}).exit_code, 0);
  const auto rendered = [&](const std::string& model) {
    write_scene("s.json", R"({"name": "m", "type": "separated", "file": "rest.sep", )" + model + "}");
    const ProgramResult result = run({"s.json", "-o", "s.exr"});
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    return std::pair(result, read_image(folder_ / "s.exr").data);
  };
  const auto [loose, any] = rendered(R"("model": "auto", "tolerance": 1)");
  EXPECT_TRUE(loose.complains("m: model sun: error ")) << loose.errors;
  EXPECT_TRUE(loose.says("residual: no separated material is rendered by the model that has it"))
      << loose.output;
  EXPECT_EQ(any, rendered(R"("model": "sun")").second);
  const auto [strict, exact] = rendered(R"("model": "auto", "tolerance": 0)");
  EXPECT_TRUE(strict.complains("m: model residual: error 0.00 %")) << strict.errors;
  EXPECT_TRUE(
      strict.says("residual: a separated material is rendered by the model that has it, by the "
                  "material \"m\""))
      << strict.output;
  EXPECT_EQ(exact, rendered(R"("model": "residual")").second);
}

TEST_F(Separate, AMaterialCannotBeRenderedByAModelItsFileLacks) {
  write_measured("m.bsdf");
  ASSERT_EQ(separate("m.bsdf", "sun.sep", {"--model", "sun"}).exit_code, 0);
  const auto scene_with = [&](const std::string& model) {
    write_text(folder_ / "s.json",
               R"({"camera": {"type": "pinhole", "origin": [0, -5, 0], "target": [0, 0, 0], "up": [0, 0, 1]},
      "film": {"width": 4, "height": 4}, "sampler": {"spp": 1},
      "materials": [{"name": "m", "type": "separated", "file": "sun.sep")" +
                   model + R"(}],
      "shapes": [{"type": "sphere", "material": "m", "center": [0, 0, 0], "radius": 1}]})");
  };
  scene_with("");
  EXPECT_EQ(run({"s.json", "-o", "s.exr"}).exit_code, 0);
  scene_with(R"(, "model": "fresnel")");
  expect_bad_input({"s.json", "-o", "t.exr"}, "sun.sep: has no tables for the model fresnel");
  scene_with(R"(, "model": "analytic")");
  expect_bad_input({"s.json", "-o", "t.exr"}, "sun.sep: has no analytic model");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "t.exr"));
}

TEST_F(Separate, AcquireRefusesWhatItCannotMeasure) {
  write_text(folder_ / "glass.json", R"({"name": "glass", "type": "dielectric", "eta": 1.5})");
  write_text(folder_ / "mirror.json", R"({"name": "mirror", "type": "conductor", "eta": 0.2, "k": 3})");
  write_text(folder_ / "two.json", "{\"name\": \"m\",\n \"type\": \"lamber\"}");
  expect_bad_input({"acquire", "glass.json", "-o", "out.bsdf"}, "glass.json:");
  expect_bad_input({"acquire", "mirror.json", "-o", "out.bsdf"}, "mirror.json:");
  expect_bad_input({"acquire", "two.json", "-o", "out.bsdf"}, "two.json:2:10: /type: ");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out.bsdf"));
}

TEST_F(Separate, SeparateSaysWhereAFitIsUnusable) {
  MeasuredTables dark = make_measured({});
  std::fill(dark.spectra.begin(), dark.spectra.end(), 0.0F);
  std::fill(dark.luminance.begin(), dark.luminance.end(), 0.0F);
  dark.valid.assign(dark.slices() * dark.table_size * dark.table_size, 0);  // nothing was measured
  measured_to_tensors(dark).write(folder_ / "dark.bsdf");
  const ProgramResult result = run({"separate", "dark.bsdf", "-o", "dark.sep"});
  EXPECT_EQ(result.exit_code, 1) << result.output << result.errors;
  EXPECT_FALSE(std::filesystem::exists(folder_ / "dark.sep"));
  // The same verdict, the same exit code, where a scene is to be separated.
  write_text(folder_ / "s.json",
             R"({"camera": {"type": "pinhole", "origin": [0, -5, 0], "target": [0, 0, 0], "up": [0, 0, 1]},
    "materials": [{"name": "m", "type": "measured", "file": "dark.bsdf"}],
    "shapes": [{"type": "sphere", "material": "m", "center": [0, 0, 0], "radius": 1}]})");
  const ProgramResult rendered = run({"s.json", "--separate", "sun", "--cache", "cache", "-o", "dark.exr"});
  EXPECT_EQ(rendered.exit_code, 1) << rendered.output << rendered.errors;
  EXPECT_FALSE(std::filesystem::exists(folder_ / "dark.exr"));
}

}  // namespace
}  // namespace spectrace::test
