// SPDX-License-Identifier: Apache-2.0
// Runs the spectrace program as a user would: own process, captured streams, exit code.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "tests/support/temporary_folder.h"

namespace spectrace::test {

struct ProgramResult {
  int exit_code = -1;  ///< -1 where it died by a signal
  int signal = 0;      ///< 0 where it exited by itself
  std::string output, errors;

  [[nodiscard]] bool says(std::string_view text) const { return output.find(text) != std::string::npos; }
  [[nodiscard]] bool complains(std::string_view text) const { return errors.find(text) != std::string::npos; }
  [[nodiscard]] std::vector<std::string> error_lines() const;
};

/// Sent to a program once it has made a file, where one is named, and has run for a while; 0: none.
struct DelayedSignal {
  int signal = 0;
  int after_ms = 0;
  std::filesystem::path after_file{};
};

/// Each argument reaches the program as it is; standard input is empty. `folder`, where given, is where it
/// runs; `output_to` receives standard output instead of the result. Throws std::system_error where the
/// program cannot be started.
ProgramResult run_program(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                          const std::filesystem::path& folder = {},
                          const std::filesystem::path& output_to = {}, DelayedSignal signal = {});

inline ProgramResult run_spectrace(const std::vector<std::string>& arguments,
                                   const std::filesystem::path& folder = {}) {
  return run_program(SPECTRACE_BINARY, arguments, folder);
}

}  // namespace spectrace::test
