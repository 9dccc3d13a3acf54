// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "core/base/json.h"
#include "core/image/image.h"
#include "materials/separated_tables.h"
#include "tests/support/run_program.h"
#include "tests/support/test_data.h"

namespace spectrace {
namespace {

using test::ProgramResult;
using test::run_spectrace;
using test::TemporaryFolder;
using test::write_text;

JsonDocument inspect_json(const std::filesystem::path& file) {
  const ProgramResult result = run_spectrace({"inspect", file.string(), "--json"});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  return JsonDocument::parse(result.output, "inspect");
}

TEST(Inspect, CountsNonFiniteAndNegativePixelsOfImages) {
  const TemporaryFolder folder;
  Image image(3, 2, {"R", "G", "B"});
  image.data = {1, 2, 3, -1, 2, 3, 1, std::numeric_limits<float>::quiet_NaN(), 3, 1, 2, 3, 1, 2, 3, 1, 2, 9};
  write_exr(folder / "f.exr", image, {{"spectrace:spp", std::int64_t(64)}});
  JsonDocument document = inspect_json(folder / "f.exr");
  const auto channels = document.root().require("channels").elements();
  ASSERT_EQ(channels.size(), 3u);
  EXPECT_EQ(channels[0].require("negative").integer(0, 0, 9), 1);
  EXPECT_EQ(channels[0].require("min").number(0), -1);
  EXPECT_EQ(channels[1].require("non_finite").integer(0, 0, 9), 1);
  EXPECT_EQ(channels[1].require("mean").number(0), 2) << "over finite values";
  EXPECT_EQ(channels[2].require("max").number(0), 9);
  EXPECT_EQ(document.root().require("image").require("rgb_layers").string(), "beauty");
  EXPECT_EQ(document.root().require("metadata").require("spectrace:spp").integer(0, 0, 99), 64);
  document.throw_if_wrong();

  const ProgramResult text = run_spectrace({"inspect", (folder / "f.exr").string()});
  EXPECT_TRUE(text.says("non_finite") && text.says("spectrace:spp")) << text.output;
}

TEST(Inspect, TellsWhatAMeasurementHoldsAndLacks) {
  const auto file = test::data_folder() / "epfl_rgb/irid_flake_paint2_rgb.bsdf";
  SPECTRACE_SKIP_WITHOUT(file);
  JsonDocument document = inspect_json(file);
  const JsonValue root = document.root();
  EXPECT_EQ(root.require("file").require("kind").string(), "measured BRDF");
  const JsonValue measurement = root.require("measurement");
  EXPECT_EQ(measurement.require("spectral_axis").string(), "RGB");
  const double last_deg = measurement.require("last_measured_elevation_deg").number(0);
  EXPECT_GT(last_deg, 78);  // hard case H1: the last measured slice lies between 78.4 and 85 degrees
  EXPECT_LT(last_deg, 85.1);
  EXPECT_GE(measurement.require("extrapolated_slices").integer(0, 0, 99), 1);
  const auto elevations = root.require("elevations").elements();
  ASSERT_FALSE(elevations.empty());
  EXPECT_EQ(elevations.front().require("source").string(), "measured");
  EXPECT_EQ(elevations.back().require("source").string(), "extrapolated");
  bool has_spectra = false;
  for (const JsonValue& field : root.require("fields").elements()) {
    if (field.require("field").string() != "rgb") continue;
    has_spectra = true;
    EXPECT_EQ(field.require("type").string(), "f32");
    EXPECT_NE(field.require("unit").string(), "");
  }
  EXPECT_TRUE(has_spectra);
  document.throw_if_wrong();
}

TEST(Inspect, TellsWhatASeparatedMaterialHolds) {
  const TemporaryFolder folder;
  SeparatedTables tables;
  tables.grid = {.n_theta_h = 2, .n_theta_d = 3, .n_phi_d = 4};
  tables.axis = SpectralAxis::wavelengths({400, 500});
  tables.c_d = {0.25f, 0.75f};
  tables.rho_s.assign(tables.grid.size(), 3);
  tables.s_sun = {1, 1};
  tables.s_fresnel.assign(3 * 2, 1);
  tables.s_diffraction.assign(2 * 3 * 2, 1);
  tables.source_name = "paint.bsdf";
  tables.source_sha256 = std::string(64, 'a');
  tables.report_json = "{\"usable\": true}";
  separated_to_tensors(tables).write(folder / "f.sep");
  JsonDocument document = inspect_json(folder / "f.sep");
  const JsonValue material = document.root().require("separated_material");
  EXPECT_EQ(material.require("source").string(), "paint.bsdf");
  EXPECT_EQ(material.require("theta_d_nodes").integer(0, 0, 99), 3);
  EXPECT_EQ(material.require("models").string(), "sun fresnel diffraction");
  EXPECT_EQ(material.require("last_nm").number(0), 500);
  EXPECT_EQ(material.require("diffuse_albedo_mean").number(0), 0.5);
  EXPECT_EQ(material.require("specular_table_max_per_sr").number(0), 3);
  EXPECT_NE(material.require("report").string().find("usable"), std::string::npos);
  document.throw_if_wrong();
}

TEST(Inspect, TellsWhatASceneHolds) {
  const TemporaryFolder folder;
  const auto scene = std::filesystem::path(SPECTRACE_SOURCE_DIR) / "scenes/cornell_box.json";
  JsonDocument document = inspect_json(scene);
  const JsonValue root = document.root();
  EXPECT_GT(root.require("scene").require("width").integer(0, 0, 100000), 0);
  EXPECT_GT(root.require("camera").require("fov_deg").number(0), 0);
  EXPECT_FALSE(root.require("materials").elements().empty());
  document.throw_if_wrong();
}

TEST(Inspect, TellsWhatALoneMaterialIs) {
  const auto scenes = std::filesystem::path(SPECTRACE_SOURCE_DIR) / "scenes";
  JsonDocument document = inspect_json(scenes / "materials/glossy.json");
  const JsonValue material = document.root().require("material");
  EXPECT_EQ(material.require("name").string(), "glossy");
  EXPECT_EQ(material.require("type").string(), "glossy");
  EXPECT_EQ(material.require("detail").string(), "alpha 0.12, specular_scale 0.5, diffuse_scale 0.5");
  EXPECT_EQ(material.require("sha256").string().size(), 64U);
  document.throw_if_wrong();

  const TemporaryFolder folder;
  write_text(folder / "paint.json", R"({"name": "paint", "type": "measured", "file": "p.bsdf"})");
  EXPECT_TRUE(run_spectrace({"inspect", (folder / "paint.json").string()}).says("p.bsdf"));
  write_text(folder / "wrong.json", "{\"name\": \"paint\",\n \"type\": \"glosy\"}");
  const ProgramResult wrong = run_spectrace({"inspect", (folder / "wrong.json").string()});
  EXPECT_EQ(wrong.exit_code, 3);
  EXPECT_TRUE(wrong.complains("wrong.json:2:10: /type: ")) << wrong.errors;
}

TEST(Inspect, RefusesWhatItDoesNotKnow) {
  const TemporaryFolder folder;
  write_text(folder / "radiance.bsdf", "<?xml version=\"1.0\"?>\n<WindowElement>");
  write_text(folder / "broken.json", "{\"camera\": ");
  write_text(folder / "broken.sep", "tensor_file");
  write_text(folder / "text.exr", "plain text");
  write_text(folder / "empty", "");
  for (const char* name :
       {"radiance.bsdf", "broken.json", "broken.sep", "text.exr", "empty", "absent.bsdf", "absent.exr"}) {
    const ProgramResult result = run_spectrace({"inspect", (folder / name).string()});
    EXPECT_EQ(result.exit_code, 3) << name;
    EXPECT_EQ(result.errors.find((folder / name).string()), 0u) << result.errors;
    EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1) << result.errors;
    EXPECT_EQ(result.output, "") << name;
  }
  EXPECT_EQ(run_spectrace({"inspect"}).exit_code, 2);
  EXPECT_TRUE(run_spectrace({"inspect", "--help"}).says("Examples:"));
}

}  // namespace
}  // namespace spectrace
