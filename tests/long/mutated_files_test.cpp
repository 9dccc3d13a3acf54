// SPDX-License-Identifier: Apache-2.0
// Thousands of damaged files through the command line: each is refused in a line that names it, or does no
// harm.
#include <gtest/gtest.h>

#include "tests/support/expect_mutated.h"

namespace spectrace::test {
namespace {

class MutatedFiles : public ::testing::TestWithParam<MutatedKind> {};

TEST_P(MutatedFiles, AreRefusedOrDoNoHarm) {
  expect_refused_or_harmless(GetParam().kind, 0, GetParam().count);
}

INSTANTIATE_TEST_SUITE_P(Every, MutatedFiles, ::testing::ValuesIn(kMutatedKinds), mutated_kind_name);

}  // namespace
}  // namespace spectrace::test
