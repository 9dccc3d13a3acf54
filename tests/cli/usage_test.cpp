// SPDX-License-Identifier: Apache-2.0
// The command line itself: help, version, and every way to use it wrongly.
#include "tests/cli/program.h"

namespace spectrace::test {
namespace {

using Usage = Program;

const std::vector<std::string> kSubcommands{"separate", "compare", "inspect", "acquire", "sheet"};

TEST_F(Usage, HelpGoesToStandardOutputWithExamples) {
  const ProgramResult help = run({"--help"});
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_EQ(help.errors, "");
  EXPECT_NE(help.output.find("Examples:"), std::string::npos);
  for (const char* option : {"--output", "--spp", "--seed", "--threads", "--separate", "--version"}) {
    EXPECT_NE(help.output.find(option), std::string::npos) << option;
  }
  for (const std::string& name : kSubcommands) {
    EXPECT_NE(help.output.find(name), std::string::npos) << name;
    const ProgramResult own = run({name, "--help"});
    EXPECT_EQ(own.exit_code, 0) << name;
    EXPECT_EQ(own.errors, "") << name;
    EXPECT_NE(own.output.find("Examples:"), std::string::npos) << name;
    EXPECT_NE(own.output.find("spectrace " + name), std::string::npos) << name;
  }
}

TEST_F(Usage, VersionNamesProjectVersionAndCommit) {
  const ProgramResult version = run({"--version"});
  EXPECT_EQ(version.exit_code, 0);
  EXPECT_EQ(version.errors, "");
  EXPECT_TRUE(version.output.starts_with("spectrace 0.")) << version.output;
  EXPECT_NE(version.output.find('('), std::string::npos) << version.output;
}

TEST_F(Usage, NothingToDoPrintsTheHelpAndFails) {
  const ProgramResult nothing = run({});
  EXPECT_EQ(nothing.exit_code, 2);
  EXPECT_EQ(nothing.output, "");
  EXPECT_NE(nothing.errors.find("Examples:"), std::string::npos);
}

TEST_F(Usage, WrongCommandLinesExitWithTwo) {
  write_lambert_scene("scene.json");
  expect_usage_error({"--no-such-option"});
  expect_usage_error({"scene.json", "--no-such-option"});
  expect_usage_error({"scene.json", "other.json"});
  expect_usage_error({"scene.json", "--spp"});
  expect_usage_error({"scene.json", "--spp", "many"});
  expect_usage_error({"scene.json", "--spp", "0"});
  expect_usage_error({"scene.json", "--spp", "-3"});
  expect_usage_error({"scene.json", "--threads", "-1"});
  expect_usage_error({"scene.json", "--seed", "x"});
  expect_usage_error({"scene.json", "--separate", "moon"});
  for (const std::string& name : kSubcommands) {
    expect_usage_error({name});
    expect_usage_error({name, "--no-such-option"});
  }
  expect_usage_error({"separate", "in.bsdf"});
  expect_usage_error({"separate", "in.bsdf", "-o", "out.sep", "--weight", "heavy"});
  expect_usage_error({"acquire", "in.json"});
  expect_usage_error({"acquire", "in.json", "-o", "out.bsdf", "--phi", "3"});
  expect_usage_error({"acquire", "in.json", "-o", "out.bsdf", "--symmetry", "2"});
  expect_usage_error({"compare", "a.exr"});
  expect_usage_error({"compare", "a.exr", "b.exr", "--max", "relmse"});
  expect_usage_error({"compare", "a.exr", "b.exr", "--max", "relmse=small"});
  expect_usage_error({"compare", "a.exr", "b.exr", "--max", "beauty=1"});
  EXPECT_EQ(names(), std::vector<std::string>{"scene.json"});
}

TEST_F(Usage, AFullDiskIsNoSuccess) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "needs /dev/full";
  const ProgramResult help = run_program(SPECTRACE_BINARY, {"--help"}, folder_.path(), "/dev/full");
  EXPECT_EQ(help.exit_code, 3);
  EXPECT_EQ(help.error_lines().size(), 1U) << help.errors;
}

}  // namespace
}  // namespace spectrace::test
