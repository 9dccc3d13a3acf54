// SPDX-License-Identifier: Apache-2.0
// `spectrace cost`: what is said of settings whose bias is known.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "core/base/json.h"
#include "core/image/image.h"
#include "tests/cli/program.h"

namespace spectrace::test {
namespace {

using Cost = Program;

struct Figures {
  double bias = 0, standard_error = 0;
  std::int64_t points = 0;
};

std::map<std::string, Figures> settings_in(const std::filesystem::path& file) {
  JsonDocument document = JsonDocument::load(file);
  std::map<std::string, Figures> settings;
  for (const JsonValue& setting : document.root().require("settings").elements()) {
    const std::string name = setting.require("knob").string() + ' ' + setting.require("name").string();
    settings[name] = {setting.require("bias_rel_mse").number(0),
                      setting.require("bias_rel_mse_standard_error").number(0),
                      std::int64_t(setting.require("points").elements().size())};
  }
  return settings;
}

TEST_F(Cost, TellsTheBiasOfWhatIsLeftOut) {
  write_lambert_scene("ball.json");
  const ProgramResult result = run({"cost", "ball.json", "-o", "report", "--budget", "3"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_TRUE(result.says("report/index.html")) << result.output;
  const auto settings = settings_in(folder_ / "report" / "cost.json");
  for (const char* name : {"exact exact", "path depth 1", "wavelengths 8", "without environment"}) {
    ASSERT_TRUE(settings.contains(name)) << name;
    EXPECT_GE(settings.at(name).points, 2) << name;
  }
  // 4 standard errors: significance 6e-5. Nothing but the sky shines: without it all is lost, but for the
  // share that epsilon takes of relMSE where pixels are dark.
  const Figures exact = settings.at("exact exact"), dark = settings.at("without environment");
  EXPECT_NEAR(exact.bias, 0, 4 * exact.standard_error);
  EXPECT_NEAR(dark.bias, 1, 0.1);
  // A convex ball under a sky: nothing arrives after the first bounce.
  const Figures direct = settings.at("path depth 1");
  EXPECT_NEAR(direct.bias, 0, 4 * direct.standard_error);
}

TEST_F(Cost, WritesAPageThatNeedsNothingElse) {
  write_lambert_scene("ball.json");
  ASSERT_EQ(run({"cost", "ball.json", "-o", "report", "--budget", "3"}).exit_code, 0);
  for (const char* file : {"cost.csv", "cost.json", "effects.svg", "ciede2000.svg", "mape.svg", "psnr_db.svg",
                           "rel_mse.svg", "pareto.svg", "noise.svg"}) {
    EXPECT_FALSE(read_text(folder_ / "report" / file).empty()) << file;
  }
  for (const char* plot : {"effects.png", "ciede2000.png", "mape.png", "psnr_db.png", "rel_mse.png",
                           "pareto.png", "noise.png"}) {
    const Image image = read_image(folder_ / "report" / plot);
    // White paper, and something on it.
    EXPECT_NEAR(image.at(image.width - 1, image.height - 1, 0), 1, 1e-3) << plot;
    EXPECT_GT(std::count_if(image.data.begin(), image.data.end(), [](float v) { return v < 0.5F; }), 500)
        << plot;
  }
  const std::string page = read_text(folder_ / "report" / "index.html");
  for (const char* outside : {"src=\"http", "href=", "<link", "url("}) {
    EXPECT_EQ(page.find(outside), std::string::npos) << outside;
  }
  EXPECT_NE(page.find("data-label=\"exact, 8 samples"), std::string::npos);
  const std::string json = read_text(folder_ / "report" / "cost.json");
  for (const char* effect : {"environment: in the scene", "dispersion: no material"}) {
    EXPECT_NE(page.find(effect), std::string::npos) << effect;
  }
  for (const char* effect : {"\"environment: in the scene\"", "\"dispersion: no material"}) {
    EXPECT_NE(json.find(effect), std::string::npos) << effect;
  }
}

TEST_F(Cost, TakesAReferenceThatIsGiven) {
  write_lambert_scene("ball.json");
  ASSERT_EQ(run({"ball.json", "-o", "truth.exr", "--spp", "1024", "--seed", "9"}).exit_code, 0);
  ASSERT_EQ(run({"cost", "ball.json", "-o", "report", "--budget", "3", "--reference", "truth.exr"}).exit_code,
            0);
  const auto settings = settings_in(folder_ / "report" / "cost.json");
  // What noise the truth has itself, well below 1 % of the squared mean, counts as bias here.
  EXPECT_NEAR(settings.at("exact exact").bias, 0, 1e-4);
  EXPECT_NEAR(settings.at("without environment").bias, 1, 0.1);
  write_text(folder_ / "small.json",
             read_text(folder_ / "ball.json").replace(read_text(folder_ / "ball.json").find("16"), 2, "12"));
  expect_bad_input({"cost", "small.json", "-o", "report", "--reference", "truth.exr"},
                   "truth.exr: has 16 x 16 pixels");
}

TEST_F(Cost, RefusesPicturesThatTellNothing) {
  write_text(folder_ / "dark.json", R"({"camera": {"origin": [0, -4, 1], "target": [0, 0, 0]},
    "film": {"width": 8, "height": 6}, "materials": [{"name": "m", "type": "lambert", "reflectance": 0.5}],
    "shapes": [{"type": "sphere", "material": "m"}]})");
  expect_bad_input({"cost", "dark.json", "-o", "report", "--budget", "2"}, "dark.json: is black");
  Image truth(8, 6, {"R", "G", "B"});
  truth.at(3, 2, 1) = std::numeric_limits<float>::quiet_NaN();
  write_exr(folder_ / "nan.exr", truth, {});
  expect_bad_input({"cost", "dark.json", "-o", "report", "--budget", "2", "--reference", "nan.exr"},
                   "nan.exr: is not finite in channel G of pixel (3, 2)");
}

TEST_F(Cost, RefusesWhatItCannotRead) {
  expect_bad_input({"cost", "none.json", "-o", "report"}, "none.json");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "report"));
  write_lambert_scene("ball.json");
  expect_bad_input({"cost", "ball.json", "-o", "ball.json"}, "ball.json: cannot make this folder");
}

}  // namespace
}  // namespace spectrace::test
