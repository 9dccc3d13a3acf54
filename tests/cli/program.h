// SPDX-License-Identifier: Apache-2.0
// What the tests of the program share: one run of it, and files small enough to be quick.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "tests/support/run_program.h"

namespace spectrace::test {

inline const std::filesystem::path kScenes = std::filesystem::path(SPECTRACE_SOURCE_DIR) / "scenes";

/// For `separate`: a hundredth of the paper's cells, where a test asks nothing about them.
inline const std::vector<std::string> kSmallGrid{"--grid", "24x20x30"};

/// Each test has a folder of its own, in which the program runs.
class Program : public ::testing::Test {
 protected:
  ProgramResult run(const std::vector<std::string>& arguments) const {
    ProgramResult result = run_spectrace(arguments, folder_.path());
    EXPECT_EQ(result.signal, 0) << "the program crashed\n" << result.errors;
    return result;
  }
  /// `spectrace separate` of `input` on kSmallGrid.
  ProgramResult separate(const std::string& input, const std::string& output,
                         const std::vector<std::string>& options = {}) const {
    std::vector<std::string> arguments{"separate", input, "-o", output};
    arguments.insert(arguments.end(), kSmallGrid.begin(), kSmallGrid.end());
    arguments.insert(arguments.end(), options.begin(), options.end());
    return run(arguments);
  }
  /// Exit code 3, one line on standard error that begins with `begin`.
  void expect_bad_input(const std::vector<std::string>& arguments, const std::string& begin) const {
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 3) << result.output << result.errors;
    ASSERT_EQ(result.error_lines().size(), 1U) << result.errors;
    EXPECT_TRUE(result.errors.starts_with(begin)) << result.errors;
  }
  /// Exit code 2, and something said about it.
  void expect_usage_error(const std::vector<std::string>& arguments) const {
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 2) << result.output << result.errors;
    EXPECT_FALSE(result.errors.empty());
    EXPECT_EQ(result.output, "");
  }
  /// A ball under a sky, 16x16 pixels; `material` is one JSON object named "m".
  void write_scene(const std::string& name, const std::string& material) const {
    write_text(folder_ / name, R"({"camera": {"origin": [0, -4, 1], "target": [0, 0, 0], "up": [0, 0, 1]},
"film": {"width": 16, "height": 16}, "sampler": {"spp": 4},
"materials": [)" + material + R"(],
"shapes": [{"type": "sphere", "material": "m"}],
"lights": [{"type": "environment", "radiance": 1}]})");
  }
  void write_lambert_scene(const std::string& name) const {
    write_scene(name, R"({"name": "m", "type": "lambert", "reflectance": 0.5})");
  }
  /// A measured BRDF of a few kilobytes.
  void write_measured(const std::string& name) const;

  /// Everything in the folder, relative to it, sorted.
  std::vector<std::string> names() const;

  TemporaryFolder folder_;
};

}  // namespace spectrace::test
