// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <string>

#include "tests/support/mutated_files.h"

namespace spectrace::test {

struct MutatedKind {
  const char* name = "";
  FileKind kind{};
  std::size_t count = 0;  ///< of a thorough test
};
inline constexpr std::array<MutatedKind, 6> kMutatedKinds{{{"Scene", FileKind::kScene, 1000},
                                                           {"Measured", FileKind::kMeasured, 1000},
                                                           {"Separated", FileKind::kSeparated, 1000},
                                                           {"Obj", FileKind::kObj, 200},
                                                           {"Exr", FileKind::kExr, 200},
                                                           {"Checkpoint", FileKind::kCheckpoint, 200}}};

inline std::string mutated_kind_name(const ::testing::TestParamInfo<MutatedKind>& info) {
  return info.param.name;
}

inline void expect_refused_or_harmless(FileKind kind, std::uint64_t first_seed, std::size_t count) {
  const MutationTally tally = run_on_mutated(kind, first_seed, count);
  for (const std::string& failure : tally.failures) ADD_FAILURE() << failure;
  EXPECT_EQ(tally.refused + tally.harmless, count);
  EXPECT_GT(tally.refused, 0U);
  std::printf("%zu refused, %zu harmless, the longest run %.2f s\n", tally.refused, tally.harmless,
              tally.longest_s);
}

}  // namespace spectrace::test
