// SPDX-License-Identifier: Apache-2.0
// --tev: what the viewer shows in the end is what is written; a viewer that is not there stops nothing.
#include <string>

#include "core/image/image.h"
#include "tests/cli/program.h"
#include "tests/support/fake_tev.h"

namespace spectrace::test {
namespace {

class LiveView : public Program {
 protected:
  void SetUp() override { write_lambert_scene("ball.json"); }
};

TEST_F(LiveView, ShowsWhatIsWritten) {
  FakeTev tev;
  const ProgramResult result = run({"ball.json", "-o", "ball.exr", "--spp", "64", "--tev",
                                    "127.0.0.1:" + std::to_string(tev.address().port)});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_EQ(result.errors, "");
  const Image written = read_image(folder_ / "ball.exr");
  const Viewer& viewer = tev.viewer();
  ASSERT_TRUE(viewer.images.contains("ball.exr"));
  const Image& shown = viewer.images.at("ball.exr");
  ASSERT_EQ(shown.channels.size(), written.channels.size());
  ASSERT_EQ(shown.width * shown.height, 16 * 16);
  for (std::size_t c = 0; c < written.channels.size(); ++c) {  // files have them in alphabetical order
    const auto found = shown.find_channel(written.channels[c]);
    ASSERT_TRUE(found.has_value()) << written.channels[c];
    for (int i = 0; i < 16 * 16; ++i) {
      ASSERT_EQ(shown.at(i % 16, i / 16, *found), written.at(i % 16, i / 16, c)) << written.channels[c];
    }
  }
}

TEST_F(LiveView, IsMissedInOneLine) {
  std::uint16_t closed = 0;
  {
    FakeTev gone(0);
    closed = gone.address().port;
    run({"ball.json", "-o", "first.exr", "--tev", "127.0.0.1:" + std::to_string(closed)});
  }
  const ProgramResult result =
      run({"ball.json", "-o", "ball.exr", "--tev", "127.0.0.1:" + std::to_string(closed)});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.error_lines().size(), 1U) << result.errors;
  EXPECT_TRUE(result.complains("tev")) << result.errors;
  EXPECT_EQ(read_image(folder_ / "ball.exr").data, read_image(folder_ / "first.exr").data);
}

}  // namespace
}  // namespace spectrace::test
