// SPDX-License-Identifier: Apache-2.0
// Damaged files of every kind, given to the program's commands that read them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace spectrace::test {

enum class FileKind { kScene, kMeasured, kSeparated, kObj, kExr, kCheckpoint };

struct MutationTally {
  std::size_t refused = 0;   ///< exit code 3
  std::size_t harmless = 0;  ///< exit code 0, or 1 where images differ or a fit is unusable
  double longest_s = 0;
  /// Seed, command and what was wrong: another exit code, no message or one that names no file, an output
  /// half written, left behind or holding pixels that are not finite, a run without end.
  std::vector<std::string> failures;
};

/// Runs the program on a damaged file for each of `count` seeds, a few at once.
MutationTally run_on_mutated(FileKind kind, std::uint64_t first_seed, std::size_t count);

}  // namespace spectrace::test
