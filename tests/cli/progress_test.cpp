// SPDX-License-Identifier: Apache-2.0
// What long work says while it lasts.
#include "core/base/json.h"
#include "tests/cli/program.h"

namespace spectrace::test {
namespace {

class ProgressOption : public Program {};

TEST_F(ProgressOption, JsonGivesAnObjectALine) {
  write_lambert_scene("scene.json");
  // More than one tile: the end is told, however soon it comes after the beginning.
  std::string text = read_text(folder_ / "scene.json");
  text.replace(text.find("\"width\": 16"), 11, "\"width\": 128");
  write_text(folder_ / "scene.json", text);
  const ProgramResult result =
      run({"scene.json", "-o", "out.exr", "--progress", "json", "--separate", "sun"});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  bool has_end = false, has_note = false;
  for (const std::string& line : result.error_lines()) {
    JsonDocument document = JsonDocument::parse(line, "line");
    const JsonValue root = document.root();
    if (root.get("note").exists()) {
      has_note = has_note || root.get("note").string().find("no measured material") != std::string::npos;
      continue;
    }
    const double done = root.require("done").number(-1, kNonNegative),
                 total = root.require("total").number(0, kPositive);
    EXPECT_GE(root.require("elapsed_s").number(-1), 0);
    EXPECT_FALSE(root.require("stage").string().empty());
    EXPECT_TRUE(root.require("remaining_s").exists());
    if (done == total) {
      EXPECT_EQ(root.require("remaining_s").number(-1), 0);
      has_end = true;
    }
    document.throw_if_wrong();
  }
  EXPECT_TRUE(has_end) << result.errors;
  EXPECT_TRUE(has_note) << result.errors;
}

TEST_F(ProgressOption, OfARenderThatATimeEndsKnowsItsEndAndTellsIt) {
  write_lambert_scene("scene.json");
  const ProgramResult result =
      run({"scene.json", "-o", "out.exr", "--progress", "json", "--spp", "1000000000", "--time", "2.5"});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  double remaining_s = -1;
  int known = 0;
  for (const std::string& line : result.error_lines()) {
    JsonDocument document = JsonDocument::parse(line, "line");
    const JsonValue root = document.root();
    const JsonValue left = root.require("remaining_s");
    remaining_s = left.is_number() ? left.number(-1) : -1;  // null: nothing tells yet
    EXPECT_LT(remaining_s, 60) << line << ": by the time, not by the samples";
    known += remaining_s >= 0 ? 1 : 0;
  }
  EXPECT_EQ(remaining_s, 0) << result.errors;
  EXPECT_GE(known, 2) << result.errors;
}

TEST_F(ProgressOption, OnATerminalIsALineThatSaysWhatIsLeft) {
  const char* const terminal = "/usr/bin/script";  // of util-linux: gives a program a terminal of its own
  if (!std::filesystem::exists(terminal)) GTEST_SKIP() << "no " << terminal;
  write_lambert_scene("scene.json");
  const ProgramResult result = run_program(
      terminal, {"-qec", SPECTRACE_BINARY " scene.json -o out.exr --spp 1000000000 --time 1", "/dev/null"},
      folder_.path());
  EXPECT_EQ(result.exit_code, 0) << result.output;
  const std::size_t begin = result.output.find("\r\033[Krendering ");
  ASSERT_NE(begin, std::string::npos) << result.output;
  EXPECT_NE(result.output.find(" s left", begin), std::string::npos) << result.output;
}

TEST_F(ProgressOption, OfShortWorkInALogIsSilent) {
  write_lambert_scene("scene.json");
  for (const char* style : {"auto", "plain"}) {
    EXPECT_EQ(run({"scene.json", "-o", "out.exr", "--progress", style}).errors, "") << style;
  }
  expect_usage_error({"scene.json", "-o", "out.exr", "--progress", "loud"});
}

}  // namespace
}  // namespace spectrace::test
