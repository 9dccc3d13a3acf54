// SPDX-License-Identifier: Apache-2.0
#include "core/spectra/lane_to_xyz.h"

#include <gtest/gtest.h>

#include <limits>

#include "core/spectra/color.h"

namespace spectrace {
namespace {

/// Only the hero counts.
SampledWavelengths hero_at_555_nm() {
  std::array<Float, kLanes> nm, pdf{};
  nm.fill(555);
  pdf[0] = Float(0.01);
  return {nm, pdf};
}

TEST(LaneToXyz, TerminatedLanesAddNothing) {
  PathXyz xyz{};
  EXPECT_TRUE(LaneToXyz(hero_at_555_nm()).add(LaneSums() += SampledSpectrum(2), xyz));
  EXPECT_NEAR(xyz[1], 2 / 0.01 / kLanes / cie_y_integral(), 1e-6);
}

TEST(LaneToXyz, TellsWhatNoPixelMayHold) {
  const LaneToXyz weights(hero_at_555_nm());
  PathXyz xyz{};
  LaneSums sums{};
  sums += SampledSpectrum(1);
  for (int lane = 1; lane < kLanes; ++lane) sums.v[lane] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(weights.add(sums, xyz)) << "of lanes that do not count";
  sums.v[0] = -1;
  EXPECT_FALSE(weights.add(sums, xyz));
  EXPECT_TRUE(weights.add(sums, xyz, true));
  sums.v[0] = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(weights.add(sums, xyz, true));
}

}  // namespace
}  // namespace spectrace
