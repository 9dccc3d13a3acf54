// SPDX-License-Identifier: Apache-2.0
#include "materials/merl_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>

#include "core/base/error.h"
#include "core/math/math.h"
#include "materials/measured_brdf.h"
#include "materials/microfacet.h"
#include "tests/support/chi_square.h"
#include "tests/support/foreign_files.h"

namespace spectrace {
namespace {

/// Coloured Lambert and GGX of this roughness.
test::RgbBrdf paint(Float alpha) {
  return [alpha](Vec3 wo, Vec3 wi) {
    const Ggx::Reflection r = Ggx{alpha, alpha}.reflect(wo, wi);
    const double specular = 0.1 * double(r.value_cos / wi.z);
    return std::array{0.1 + specular, 0.05 + specular, 0.02 + 0.5 * specular};
  };
}

Vec3 random_direction(test::TestRandom& random) {
  const double theta = 1.3 * double(random.uniform()), phi = 2 * kPi64 * double(random.uniform());
  return {Float(std::sin(theta) * std::cos(phi)), Float(std::sin(theta) * std::sin(phi)),
          Float(std::cos(theta))};
}

struct Errors {
  double median, percentile_99;
};

/// Relative errors of read(wo, wi), an array of three, over random pairs up to 75 degrees.
template <typename Read>
Errors errors_of(const test::RgbBrdf& truth, const Read& read) {
  test::TestRandom random(11);
  std::vector<double> errors;
  for (int i = 0; i < 20'000; ++i) {
    const Vec3 wo = random_direction(random), wi = random_direction(random);
    const std::array<double, 3> expected = truth(wo, wi), found = read(wo, wi);
    for (std::size_t c = 0; c < 3; ++c) errors.push_back(std::abs(found[c] / expected[c] - 1));
  }
  std::sort(errors.begin(), errors.end());
  return {errors[errors.size() / 2], errors[errors.size() * 99 / 100]};
}

std::string problem_of(const std::vector<std::byte>& bytes, const std::string& name = "m.binary") {
  try {
    measured_from_bytes(bytes, name);
  } catch (const InputError& e) {
    return e.diagnostics().front().text();
  }
  return "";
}

void put_double(std::vector<std::byte>& bytes, std::size_t index, double x) {
  std::memcpy(bytes.data() + 12 + index * sizeof(double), &x, sizeof(x));
}

TEST(MerlFile, ReadsBackWhatWasWritten) {
  const auto truth = paint(Float(0.2));
  const MerlBrdf brdf(test::merl_file(truth), "m.binary");
  EXPECT_EQ(brdf.bins(), 1'458'000U);
  EXPECT_GT(brdf.invalid_bins(), 300'000U);  // a quarter of the bins lies below the horizon
  EXPECT_LT(brdf.invalid_bins(), 400'000U);
  const Errors e = errors_of(truth, [&](Vec3 wo, Vec3 wi) {
    std::array<float, 3> v{};
    EXPECT_TRUE(brdf.read(wo, wi, v));
    return std::array{double(v[0] / wi.z), double(v[1] / wi.z), double(v[2] / wi.z)};
  });
  EXPECT_LT(e.median, 3e-4);           // observed 1.6e-4: trilinear between bins
  EXPECT_LT(e.percentile_99, 2.6e-3);  // observed 1.3e-3
}

TEST(MerlFile, SurvivesTheConversion) {
  // Twice what was observed: 0.055 and 0.073 % at the median, 0.66 and 1.2 % at the 99th percentile.
  for (const auto& [alpha, median, percentile_99] :
       {std::tuple{Float(0.2), 0.0011, 0.013}, std::tuple{Float(0.05), 0.0015, 0.024}}) {
    const auto truth = paint(alpha);
    const MeasuredTables tables = measured_from_bytes(test::merl_file(truth), "folder/m.binary");
    EXPECT_TRUE(tables.axis.is_rgb());
    EXPECT_EQ(tables.file_name, "folder/m.binary");
    EXPECT_EQ(tables.source.format, "MERL binary");
    EXPECT_EQ(tables.source.samples, 1'458'000U);
    EXPECT_LT(tables.source.filled_cells, 200U);  // of 131,072: beside the horizon, among invalid bins
    const MeasuredBrdf brdf(tables);
    const Errors e = errors_of(truth, [&](Vec3 wo, Vec3 wi) {
      const auto at = brdf.footprint(wo, wi);
      std::array<double, 3> sum{};
      for (int i = 0; at && i < at->count; ++i) {
        for (std::size_t c = 0; c < 3; ++c) {
          sum[c] += double(at->weight[i]) * double(brdf.spectrum(at->row[i])[c]) / double(wi.z);
        }
      }
      return sum;
    });
    EXPECT_LT(e.median, median) << alpha;
    EXPECT_LT(e.percentile_99, percentile_99) << alpha;
  }
}

TEST(MerlFile, InvalidBinsAreLeftOutAndCounted) {
  std::vector<std::byte> bytes = test::merl_file([](Vec3, Vec3) { return std::array{0.3, 0.2, 0.1}; });
  const std::size_t all = MerlBrdf(bytes, "m.binary").invalid_bins();
  // One bin, in green alone; and all bins of theta_h up to 30 degrees.
  const std::size_t bin = (std::size_t(70) * 90 + 10) * 180 + 90;
  put_double(bytes, 1'458'000 + bin, -1);
  const MerlBrdf one(bytes, "m.binary");
  EXPECT_EQ(one.invalid_bins(), all + 1);
  const double degree = kPi64 / 180;
  const DirectionPair at = from_half_difference({70 * 70 / 90.0 * degree, 10.4 * degree, 90.4 * degree});
  std::array<float, 3> v{};
  EXPECT_TRUE(one.read(at.wo, at.wi, v));  // 64 % of the weight lies on other bins
  EXPECT_NEAR(v[0] / at.wi.z, 0.3, 1e-5);
  const DirectionPair on = from_half_difference({70 * 70 / 90.0 * degree, 10.1 * degree, 90.1 * degree});
  EXPECT_FALSE(one.read(on.wo, on.wi, v));
  EXPECT_NEAR(v[0] / on.wi.z, 0.3, 1e-5);

  for (std::size_t i = 0; i < std::size_t(52) * 90 * 180; ++i) put_double(bytes, i, -1);
  const MeasuredTables tables = measured_from_bytes(bytes, "m.binary");
  EXPECT_GT(tables.source.filled_cells, 500U);
  const auto invalid = std::size_t(std::count(tables.valid.begin(), tables.valid.end(), 0));
  EXPECT_GE(invalid, tables.source.filled_cells);
}

TEST(MerlFile, NamesTheFieldOfWhatIsWrong) {
  const std::vector<std::byte> good = test::merl_file([](Vec3, Vec3) { return std::array{0.1, 0.1, 0.1}; });
  EXPECT_EQ(problem_of(good, "any.name"), "");  // told by its content
  std::vector<std::byte> bytes = good;
  bytes[0] = std::byte(91);
  EXPECT_EQ(problem_of(bytes), "m.binary:byte 0: field \"dims\": expected 90 x 90 x 180, little endian");
  EXPECT_NE(problem_of({}), "");
  bytes = good;
  bytes.resize(bytes.size() - 8);
  EXPECT_NE(problem_of(bytes).find("34992004 bytes, expected 34992012"), std::string::npos)
      << problem_of(bytes);
  bytes = good;
  put_double(bytes, 1'458'000 + 181, std::numeric_limits<double>::quiet_NaN());
  EXPECT_NE(problem_of(bytes).find("field \"G\": value nan at [0,1,1]"), std::string::npos)
      << problem_of(bytes);
  put_double(bytes, 1'458'000 + 181, 1e300);
  EXPECT_NE(problem_of(bytes).find("expected a finite number"), std::string::npos);
}

}  // namespace
}  // namespace spectrace
