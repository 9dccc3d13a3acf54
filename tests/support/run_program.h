// SPDX-License-Identifier: Apache-2.0
// Runs the spectrace program as a user would.
#pragma once

#include <sys/wait.h>

#include <cstdlib>
#include <initializer_list>
#include <string>

#include "tests/support/temporary_folder.h"

namespace spectrace::test {

struct ProgramResult {
  int exit_code = -1;  ///< -1 where it died by a signal
  std::string output, errors;

  [[nodiscard]] bool says(std::string_view text) const { return output.find(text) != std::string::npos; }
  [[nodiscard]] bool complains(std::string_view text) const { return errors.find(text) != std::string::npos; }
};

/// Each argument reaches the program as it is.
inline ProgramResult run_spectrace(std::initializer_list<std::string> arguments) {
  const TemporaryFolder folder;
  std::string command = "'" SPECTRACE_BINARY "'";
  for (const std::string& argument : arguments) {
    command += " '";
    for (const char c : argument) command += c == '\'' ? std::string("'\\''") : std::string(1, c);
    command += "'";
  }
  command += " >'" + (folder / "out").string() + "' 2>'" + (folder / "err").string() + "' </dev/null";
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_text(folder / "out"), read_text(folder / "err")};
}

}  // namespace spectrace::test
