// SPDX-License-Identifier: Apache-2.0
#include "materials/measured_albedo.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>

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

/// Values at one elevation and wavelength 1.5 times what a material of albedo 0.8 has there: 1.2.
struct Bright {
  static constexpr std::size_t kElevation = 4, kWavelength = 1;
  MeasuredTables tables = lambert(Float(0.8));
  std::size_t cells = tables.table_size * std::size_t(tables.table_size);
  std::size_t begin = (kElevation * tables.axis.size() + kWavelength) * cells;
  Bright() {
    for (std::size_t i = begin; i < begin + cells; ++i) tables.spectra[i] *= 1.5F;
  }
};

TEST(MeasuredAlbedo, NamesWhereMoreLightLeavesThanCame) {
  const MeasuredBrdf whole(lambert(Float(0.8)));
  EXPECT_FALSE(albedo_warning(largest_albedo(whole), whole.axis()));

  const Bright made;
  const MeasuredBrdf bright(made.tables);
  const AlbedoPeak peak = largest_albedo(bright);
  EXPECT_NEAR(peak.albedo, 1.2, 1.5 * kTolerance);
  EXPECT_NEAR(peak.theta_deg, radians_to_degrees(made.tables.theta_i[Bright::kElevation]), 1e-4);
  EXPECT_EQ(peak.index, Bright::kWavelength);
  const auto warning = albedo_warning(peak, bright.axis());
  ASSERT_TRUE(warning);
  EXPECT_NE(warning->find("550 nm"), std::string::npos) << *warning;
}

TEST(MeasuredAlbedo, ClippedOrScaledNothingReflectsMoreThanItReceives) {
  const Bright bright;
  const double peak = largest_albedo(MeasuredBrdf(bright.tables)).albedo;
  for (const AlbedoLimit limit : {AlbedoLimit::kKeep, AlbedoLimit::kClip, AlbedoLimit::kScale}) {
    MeasuredTables limited = bright.tables;
    limit_albedo(limited, limit);
    const MeasuredBrdf brdf(limited);
    EXPECT_NEAR(largest_albedo(brdf).albedo, limit == AlbedoLimit::kKeep ? peak : 1, 1e-6);
    EXPECT_EQ(albedo_warning(largest_albedo(brdf), brdf.axis()).has_value(), limit == AlbedoLimit::kKeep);
    for (std::size_t i = 0; i < limited.spectra.size(); ++i) {
      const bool is_bright = i >= bright.begin && i < bright.begin + bright.cells;
      const bool is_divided = limit == AlbedoLimit::kScale || (limit == AlbedoLimit::kClip && is_bright);
      const double expected = double(bright.tables.spectra[i]) / (is_divided ? peak : 1);
      ASSERT_NEAR(limited.spectra[i], expected, 1e-6 * expected) << i;
    }
  }
}

TEST(MeasuredAlbedo, CopiesBeyondTheLastMeasuredElevationAreClippedWithIt) {
  MeasuredTables tables = lambert(Float(0.8));
  const std::size_t slice = tables.spectra.size() / tables.slices();
  for (std::size_t i = 0; i < slice; ++i) {  // the last elevation a copy of the one before
    const std::size_t last = (tables.slices() - 1) * slice + i;
    tables.spectra[last - slice] *= 1.5F;
    tables.spectra[last] = tables.spectra[last - slice];
  }
  const std::size_t size = std::size_t(tables.warp_size) * std::size_t(tables.warp_size);
  std::copy_n(tables.vndf.end() - 2 * std::ptrdiff_t(size), size, tables.vndf.end() - std::ptrdiff_t(size));
  const std::size_t cells = std::size_t(tables.table_size) * std::size_t(tables.table_size);
  std::copy_n(tables.luminance.end() - 2 * std::ptrdiff_t(cells), cells,
              tables.luminance.end() - std::ptrdiff_t(cells));
  ASSERT_LT(tables.last_measured_theta_i(), tables.theta_i.back());
  limit_albedo(tables, AlbedoLimit::kClip);
  EXPECT_NEAR(largest_albedo(MeasuredBrdf(tables)).albedo, 1, 1e-6);
  EXPECT_LT(tables.last_measured_theta_i(), tables.theta_i.back()) << "no longer a copy";
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
