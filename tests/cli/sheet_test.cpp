// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>

#include "core/image/image.h"
#include "tests/support/run_program.h"

namespace spectrace {
namespace {

using test::ProgramResult;
using test::run_spectrace;

class Sheet : public testing::Test {
 protected:
  Sheet() {
    Image image(20, 10, {"R", "G", "B", "specular.R", "specular.G", "specular.B"});
    for (std::size_t i = 0; i < image.data.size(); ++i) image.data[i] = i % 6 < 3 ? 1.0f : 0.25f;
    write_exr(input_, image, {});
  }
  [[nodiscard]] float brightest() const {
    const Image sheet = read_image(output_);
    return *std::max_element(sheet.data.begin(), sheet.data.end());
  }
  test::TemporaryFolder folder_;
  std::string input_ = (folder_ / "in.exr").string(), output_ = (folder_ / "out.png").string();
};

TEST_F(Sheet, PutsImagesSideBySide) {
  const ProgramResult result = run_spectrace({"sheet", output_, input_, input_, "--columns", "2"});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  const Image sheet = read_image(output_);
  EXPECT_EQ(sheet.width, 8 + 2 * 28);  // two cells of 20 pixels, gaps of 8
  EXPECT_EQ(brightest(), 1);
}

TEST_F(Sheet, ShowsTheNamedLayerWithExposure) {
  EXPECT_EQ(
      run_spectrace({"sheet", output_, input_, "--layer", "specular", "--labels", "", "--exposure", "2"})
          .exit_code,
      0);
  const Image sheet = read_image(output_);
  // 8-bit sRGB: half a step at linear 0.5 is 0.5 / 255 / (slope 1.45) = 0.003.
  EXPECT_NEAR(sheet.at(8, 8, 0), 0.5f, 0.003f);
  EXPECT_EQ(run_spectrace({"sheet", output_, input_, "--layer", "diffuse"}).exit_code, 3);
}

TEST_F(Sheet, RefusesWrongUse) {
  EXPECT_EQ(run_spectrace({"sheet", (folder_ / "out.jpg").string(), input_}).exit_code, 2);
  EXPECT_EQ(run_spectrace({"sheet", output_, input_, "--labels", "a,b"}).exit_code, 2);
  EXPECT_EQ(run_spectrace({"sheet", output_}).exit_code, 2);
  EXPECT_EQ(run_spectrace({"sheet", output_, (folder_ / "absent.exr").string()}).exit_code, 3);
  EXPECT_FALSE(std::filesystem::exists(output_));
  EXPECT_EQ(run_spectrace({"sheet", "--help"}).exit_code, 0);
}

}  // namespace
}  // namespace spectrace
