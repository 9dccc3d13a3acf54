// SPDX-License-Identifier: Apache-2.0
// A scene's "quality": an end to the render, and a setting out of a measurement.
#include <string>

#include "tests/cli/program.h"

namespace spectrace::test {
namespace {

class QualityKey : public Program {
 protected:
  /// A ball under a sky that asks for `quality`.
  void write(const std::string& quality) const {
    write_lambert_scene("ball.json");
    std::string text = read_text(folder_ / "ball.json");
    const std::string sampler = "\"sampler\": {\"spp\": 4}";
    text.replace(text.find(sampler), sampler.size(), "\"quality\": " + quality);
    write_text(folder_ / "ball.json", text);
  }
  void write_measurement(const std::string& settings, int depth = 8) const {
    write_text(folder_ / "cost.json",
               R"({"scene": "ball.json", "content": "m; 1 shapes, 1 lights, path depth )" +
                   std::to_string(depth) + R"(", "width": 16, "height": 16, "threads": 2,
"reference_rel_mse": 1e-9, "settings": [)" +
                   settings + "]}");
  }
  static std::string setting(const std::string& knob, const std::string& name, const std::string& noise,
                             const std::string& bias, const std::string& seconds) {
    return R"({"knob": ")" + knob + R"(", "name": ")" + name +
           R"(", "kernel": "lean", "noise_rel_mse_at_one_sample": )" + noise +
           R"(, "noise_exponent": 1, "bias_rel_mse": )" + bias +
           R"(, "bias_rel_mse_standard_error": 0, "seconds_start": 0, "seconds_a_sample": )" + seconds + "}";
  }
};

TEST_F(QualityKey, SaysWhatItPicked) {
  write(R"({"relative_error": 0.02})");
  const ProgramResult by_error = run({"ball.json", "-o", "out.exr"});
  EXPECT_EQ(by_error.exit_code, 0) << by_error.errors;
  EXPECT_TRUE(by_error.says("quality relative error 0.02: ")) << by_error.output;
  write(R"({"seconds": 0.2})");
  EXPECT_TRUE(run({"ball.json", "-o", "out.exr"}).says("quality 0.2 s: "));
  const ProgramResult overridden = run({"ball.json", "-o", "out.exr", "--spp", "16"});
  EXPECT_TRUE(overridden.says(" 16 samples a pixel")) << overridden.output;
  EXPECT_FALSE(overridden.says("quality"));
}

TEST_F(QualityKey, TakesTheCheapestSettingOfAMeasurement) {
  // Depth 1 is four times as fast and off by 3 %: good enough for 5 %, not for 2 %.
  write_measurement(setting("exact", "exact", "0.04", "0", "0.04") + ", " +
                    setting("path depth", "1", "0.04", "9e-4", "0.01"));
  write(R"({"relative_error": 0.05, "measurement": "cost.json"})");
  const ProgramResult rough = run({"ball.json", "-o", "out.exr"});
  // 0.04 / (0.05² - 9e-4) = 25.
  EXPECT_NE(rough.errors.find("path depth 1, 25 samples"), std::string::npos) << rough.errors;
  EXPECT_TRUE(rough.says(", 25 samples a pixel")) << rough.output;
  EXPECT_TRUE(rough.says("approximation path depth 1 for a quality of relative error 0.05")) << rough.output;
  write(R"({"relative_error": 0.02, "measurement": "cost.json"})");
  const ProgramResult fine = run({"ball.json", "-o", "out.exr"});
  EXPECT_NE(fine.errors.find("exact, 100 samples"), std::string::npos) << fine.errors;
  EXPECT_FALSE(fine.says("approximation")) << fine.output;
}

TEST_F(QualityKey, RefusesWhatCannotBe) {
  write(R"({"relative_error": 0.02, "seconds": 3})");
  expect_bad_input({"ball.json", "-o", "out.exr"}, "ball.json:2:");
  write(R"({"relative_error": 0})");
  expect_bad_input({"ball.json", "-o", "out.exr"}, "ball.json:2:");
  write(R"({"relative_error": 0.02, "measurement": "cost.json"})");
  expect_bad_input({"ball.json", "-o", "out.exr"}, "ball.json:2:");
  write_measurement("");
  expect_bad_input({"ball.json", "-o", "out.exr"}, "cost.json:");
  write_measurement(setting("path depth", "1", "0.04", "9e-4", "0.01"));
  expect_bad_input({"ball.json", "-o", "out.exr"}, "cost.json: no setting reaches");
  write_measurement(setting("model", "sun", "0.04", "0", "0.01"));
  expect_bad_input({"ball.json", "-o", "out.exr"}, "cost.json: its best setting is \"model sun\"");
  write_measurement(setting("exact", "exact", "0.04", "0", "0.04"), 7);
  expect_bad_input({"ball.json", "-o", "out.exr"}, "cost.json: measured on another scene, ball.json");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out.exr"));
}

}  // namespace
}  // namespace spectrace::test
