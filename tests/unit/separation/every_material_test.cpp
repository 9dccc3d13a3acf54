// SPDX-License-Identifier: Apache-2.0
// Whatever a measurement holds, its tables are finite and non-negative, and the report accounts for each
// cell.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "separation/separate.h"
#include "tests/support/test_data.h"
#include "tests/support/acquired.h"

namespace spectrace::test {
namespace {

namespace fs = std::filesystem;

bool all_finite_and_non_negative(const std::vector<float>& values) {
  return std::all_of(values.begin(), values.end(), [](float x) { return std::isfinite(x) && x >= 0; });
}
bool all_finite(const std::vector<float>& values) {
  return std::all_of(values.begin(), values.end(), [](float x) { return std::isfinite(x); });
}

void expect_sound_tables(const MeasuredBrdf& measured) {
  SeparationOptions options;
  options.grid = {.n_theta_h = 30, .n_theta_d = 20, .n_phi_d = 30};
  options.residual_rank = kDefaultResidualRank;
  options.analytic = true;
  SilentProgress progress;
  const auto [tables, report] = separate(measured, options, progress);
  ASSERT_TRUE(report.usable) << report.verdict;
  EXPECT_EQ(report.unfinished, 0);
  EXPECT_TRUE(all_finite_and_non_negative(tables.c_d));
  EXPECT_TRUE(all_finite_and_non_negative(tables.rho_s));
  EXPECT_TRUE(all_finite_and_non_negative(tables.s_sun));
  EXPECT_TRUE(all_finite_and_non_negative(tables.s_fresnel));
  EXPECT_TRUE(all_finite_and_non_negative(tables.s_diffraction));
  EXPECT_TRUE(all_finite_and_non_negative(tables.analytic));
  EXPECT_TRUE(all_finite(tables.residual.basis));
  EXPECT_LE(*std::max_element(tables.c_d.begin(), tables.c_d.end()), 1.0F) << "a Lambert lobe's albedo";
  EXPECT_EQ(report.measured + report.extrapolated + report.invalid + report.below_horizon, report.cells);
  EXPECT_EQ(report.cells, options.grid.size());
  EXPECT_GT(report.below_horizon, 0U);
}

/// By name, so that a run says which files it had; empty where there is no data folder.
std::vector<std::string> real_files() {
  std::vector<std::string> names;
  std::error_code absent;
  for (fs::directory_iterator entry(data_folder() / "epfl_rgb", absent), end; !absent && entry != end;
       entry.increment(absent)) {
    if (entry->path().extension() == ".bsdf") names.push_back(entry->path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

class EveryMaterial : public ::testing::TestWithParam<std::string> {};
TEST_P(EveryMaterial, OfTheDataFolderHasSoundTables) {
  expect_sound_tables(MeasuredBrdf(read_measured(data_folder() / "epfl_rgb" / (GetParam() + ".bsdf"))));
}
INSTANTIATE_TEST_SUITE_P(Real, EveryMaterial, ::testing::ValuesIn(real_files()),
                         [](const auto& file) { return file.param; });
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(EveryMaterial);

class OwnMaterial : public ::testing::TestWithParam<const char*> {};
TEST_P(OwnMaterial, HasSoundTables) { expect_sound_tables(acquired(GetParam())); }
// Purely diffuse, purely metallic, and with all that the method tells apart.
INSTANTIATE_TEST_SUITE_P(Acquired, OwnMaterial,
                         ::testing::Values("matte", "gold", "pearlescent", "diffractive_flakes"),
                         [](const auto& name) { return std::string(name.param); });

}  // namespace
}  // namespace spectrace::test
