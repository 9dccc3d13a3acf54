// SPDX-License-Identifier: Apache-2.0
// Twenty damaged files of each kind; tests/long has thousands.
#include <gtest/gtest.h>

#include "tests/support/expect_mutated.h"

namespace spectrace::test {
namespace {

constexpr std::size_t kEach = 20;
constexpr std::uint64_t kFirstSeed = 1'000'000;  // others than in tests/long

class MutatedFiles : public ::testing::TestWithParam<MutatedKind> {};

TEST_P(MutatedFiles, AreRefusedOrDoNoHarm) { expect_refused_or_harmless(GetParam().kind, kFirstSeed, kEach); }

INSTANTIATE_TEST_SUITE_P(Every, MutatedFiles, ::testing::ValuesIn(kMutatedKinds), mutated_kind_name);

}  // namespace
}  // namespace spectrace::test
