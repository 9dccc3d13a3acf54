// SPDX-License-Identifier: Apache-2.0
// The recovered c_d(λ) at all 195 wavelengths, on the paper's grid.
#include "tests/support/known_truth.h"

#include <gtest/gtest.h>

namespace spectrace::test {
namespace {

class KnownTruth : public ::testing::TestWithParam<KnownMaterial> {};

TEST_P(KnownTruth, TheDiffuseColourComesBackAtAllWavelengths) {
  expect_recovered(GetParam(), fine_acquisition(), {});
}

TEST_P(KnownTruth, TheDiffuseColourComesBackFromTheDatabasesGrid) {
  if (!GetParam().on_coarse_grid) GTEST_SKIP() << GetParam().name << " needs a fine measurement";
  expect_recovered(GetParam(), {}, {});
}

INSTANTIATE_TEST_SUITE_P(All, KnownTruth, ::testing::ValuesIn(kKnownMaterials),
                         [](const auto& material) { return std::string(material.param.name); });

}  // namespace
}  // namespace spectrace::test
