// SPDX-License-Identifier: Apache-2.0
// Whole files of every kind that the program reads, and the commands that read them: what is damaged for
// tests.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tests/support/mutated_files.h"

namespace spectrace::test {

/// One command that reads one file.
struct Reading {
  std::string damaged;  ///< the file, relative to the folder
  bool is_text = false;
  std::vector<std::string> command;
  std::vector<std::string> outputs{};  ///< all that the command may write
  std::vector<std::string> files{};    ///< others that it reads, as messages name them
  bool may_differ = false;             ///< exit code 1 is an answer: images differ, a fit is unusable
  bool lists_mistakes = false;         ///< one line for each of several
};

/// Writes them into an empty folder. Small: a run takes a second at most.
std::vector<Reading> write_readable_inputs(FileKind kind, const std::filesystem::path& folder);

}  // namespace spectrace::test
