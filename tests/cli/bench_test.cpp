// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"

namespace spectrace {
namespace {

using test::run_spectrace;

TEST(Bench, CountsWhatItMeasures) {
  const test::TemporaryFolder folder;
  const std::string scene = (folder / "scene.json").string(), json = (folder / "bench.json").string();
  // Every ray from inside hits the shell, which emits: one ray a path, and no shadow ray from there.
  std::ofstream(scene) << R"({
    "camera": {"type": "pinhole", "origin": [0, 0, 0], "target": [0, 1, 0], "up": [0, 0, 1], "fov_deg": 40},
    "film": {"width": 32, "height": 16},
    "integrator": {"max_depth": 0},
    "materials": [{"name": "black", "type": "lambert", "reflectance": 0}],
    "shapes": [{"type": "mesh", "material": "black", "emission": 1,
                "positions": [[-99, 3, -99], [99, 3, -99], [0, 3, 199]], "triangles": [[0, 1, 2]]}]})";
  const test::ProgramResult result =
      run_spectrace({"bench", scene, "--spp", "12", "--threads", "2", "--json", json});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const auto report = nlohmann::json::parse(std::ifstream(json));
  const auto& render = report.at("render");
  EXPECT_EQ(render.at("paths"), 32 * 16 * 12);
  EXPECT_EQ(render.at("rays_per_path"), 1.0);
  EXPECT_EQ(render.at("triangles"), 1);
  EXPECT_EQ(render.at("threads"), 2);
  double share = 0;
  for (const auto& part : report.at("time_of_one_thread")) share += part.at("share").get<double>();
  EXPECT_NEAR(share, 1, 1e-9);
  const auto& embree = report.at("embree_alone");
  EXPECT_GT(embree.at("single_million_rays_per_second"), 0);
  EXPECT_GT(embree.at("packets_million_rays_per_second"), 0);
  EXPECT_NE(result.output.find("render_over_raw"), std::string::npos);
}

TEST(Bench, RefusesWrongUse) {
  EXPECT_EQ(run_spectrace({"bench"}).exit_code, 2);
  EXPECT_EQ(run_spectrace({"bench", "absent.json"}).exit_code, 3);
  EXPECT_EQ(run_spectrace({"bench", "absent.json", "--spp", "0"}).exit_code, 2);
}

}  // namespace
}  // namespace spectrace
