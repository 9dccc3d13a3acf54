// SPDX-License-Identifier: Apache-2.0
// H13: wavelengths outside the data, one bin and 195, tables out of order. Through the program.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "core/image/image.h"
#include "tests/support/acquired.h"
#include "tests/support/run_program.h"

namespace spectrace::test {
namespace {

std::string scene(const std::string& film, const std::string& reflectance) {
  return R"({"camera": {"origin": [0, -4, 1], "target": [0, 0, 0], "up": [0, 0, 1]},
"spectrum": {"range_nm": [300, 1100]}, "film": {"width": 8, "height": 8)" +
         film + R"(}, "sampler": {"spp": 16},
"materials": [{"name": "m", "type": "measured", "file": "m.bsdf"},
{"name": "grey", "type": "lambert", "reflectance": )" +
         reflectance + R"(}],
"shapes": [{"type": "sphere", "material": "m"}, {"type": "sphere", "center": [2, 0, 0], "material": "grey"}],
"lights": [{"type": "environment", "radiance": 1}]})";
}

class H13_Wavelengths : public ::testing::Test {
 protected:
  void SetUp() override { measured_to_tensors(acquired_tables("pearlescent")).write(folder_ / "m.bsdf"); }
  ProgramResult render(const std::string& text) const {
    write_text(folder_ / "scene.json", text);
    return run_spectrace({"scene.json", "-o", "out.exr"}, folder_.path());
  }
  TemporaryFolder folder_;
};

TEST_F(H13_Wavelengths, OutsideTheDataTheNearestHoldsInAnyNumberOfBins) {
  // The measurement ends at 400 and 700 nm.
  for (const int bins : {1, 195}) {
    const ProgramResult result =
        render(scene(R"(, "spectral": {"bins": )" + std::to_string(bins) + "}", "0.5"));
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_TRUE(result.says(" 0 invalid samples")) << result.output;
    const Image image = read_image(folder_ / "out.spectral.exr");
    EXPECT_EQ(image.channels.size(), std::size_t(bins) + 3);
    for (const float x : image.data) ASSERT_TRUE(std::isfinite(x));
    for (std::size_t c = 3; c < image.channels.size(); ++c) {
      double sum = 0;
      for (int y = 0; y < 8; ++y) {
        for (int x = 0; x < 8; ++x) sum += double(image.at(x, y, c));
      }
      EXPECT_GT(sum, 0) << image.channels[c] << ": a sky of 1 shows at every wavelength";
    }
  }
}

TEST_F(H13_Wavelengths, OutOfOrderOrTwiceIsAnErrorWithItsPlace) {
  for (const char* nm : {"[400, 600, 500]", "[400, 500, 500]"}) {
    const ProgramResult result =
        render(scene("", std::string(R"({"wavelengths_nm": )") + nm + R"(, "values": [0.1, 0.2, 0.3]})"));
    EXPECT_EQ(result.exit_code, 3) << nm;
    ASSERT_EQ(result.error_lines().size(), 1U) << result.errors;
    EXPECT_TRUE(result.complains("scene.json:4:")) << result.errors;
    EXPECT_TRUE(result.complains("/materials/1/reflectance/wavelengths_nm")) << result.errors;
  }
}

}  // namespace
}  // namespace spectrace::test
