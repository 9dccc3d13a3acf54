// SPDX-License-Identifier: Apache-2.0
#include "materials/measured_albedo.h"

#include <gtest/gtest.h>

#include "core/base/progress.h"
#include "core/math/math.h"
#include "materials/acquisition.h"
#include "tests/support/synthetic_measured.h"
#include "tests/support/test_data.h"

namespace spectrace {
namespace {

MeasuredTables lambert(Float albedo) {
  AcquisitionOptions options;
  options.lambda_nm = {450, 550, 650};
  SilentProgress progress;
  return acquire(Lambert{Texture(Spectrum::constant(albedo))}, options, progress);
}

// Middles of 32 x 32 cells, tables of 32 x 32: 0.3 % was seen.
constexpr double kTolerance = 0.01;

TEST(MeasuredAlbedo, OfAKnownMaterialIsFound) {
  EXPECT_NEAR(largest_albedo(MeasuredBrdf(lambert(Float(0.8)))).albedo, 0.8, kTolerance);
}

TEST(MeasuredAlbedo, NamesWhereMoreLightLeavesThanCame) {
  MeasuredTables tables = lambert(Float(0.8));
  const MeasuredBrdf whole(tables);
  EXPECT_FALSE(albedo_warning(largest_albedo(whole), whole.axis()));

  constexpr std::size_t kElevation = 4, kWavelength = 1;
  const std::size_t cells = tables.table_size * std::size_t(tables.table_size);
  float* const slice = tables.spectra.data() + (kElevation * tables.axis.size() + kWavelength) * cells;
  for (std::size_t i = 0; i < cells; ++i) slice[i] *= 1.5F;
  const MeasuredBrdf bright(tables);
  const AlbedoPeak peak = largest_albedo(bright);
  EXPECT_NEAR(peak.albedo, 1.2, 1.5 * kTolerance);
  EXPECT_NEAR(peak.theta_deg, radians_to_degrees(tables.theta_i[kElevation]), 1e-4);
  EXPECT_EQ(peak.index, kWavelength);
  const auto warning = albedo_warning(peak, bright.axis());
  ASSERT_TRUE(warning);
  EXPECT_NE(warning->find("550 nm"), std::string::npos) << *warning;
}

TEST(MeasuredAlbedo, ElevationsBeyondTheLastMeasuredDoNotCount) {
  MeasuredTables tables = test::make_measured({.rgb = true});
  const MeasuredBrdf whole(tables);
  const AlbedoPeak peak = largest_albedo(whole);
  EXPECT_LE(peak.theta_deg, radians_to_degrees(whole.last_measured_theta_i()) + 1e-4);
  EXPECT_GT(peak.albedo, 0);
}

}  // namespace
}  // namespace spectrace
