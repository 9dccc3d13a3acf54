// SPDX-License-Identifier: Apache-2.0
#include "materials/scattered_brdf.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "core/base/error.h"
#include "core/base/file.h"
#include "materials/measured_brdf.h"
#include "materials/microfacet.h"
#include "tests/support/chi_square.h"
#include "tests/support/foreign_files.h"
#include "tests/support/test_data.h"

namespace spectrace {
namespace {

const std::vector<double> kFewWavelengths{400, 500, 600, 700};

double satin(Vec3 wo, Vec3 wi, double lambda_nm) {
  const Ggx::Reflection r = Ggx{Float(0.35), Float(0.35)}.reflect(wo, wi);
  return 0.05 + 0.1 * (lambda_nm - 400) / 300 + 0.2 * double(r.value_cos / wi.z);
}

std::vector<std::byte> bytes_of(const std::string& text) {
  const auto* begin = reinterpret_cast<const std::byte*>(text.data());
  return {begin, begin + text.size()};
}

std::string problem_of(const std::string& text) {
  try {
    parse_scattered(text, "m.brdf");
  } catch (const InputError& e) {
    return e.diagnostics().front().text();
  }
  return "";
}

/// The lines of a good file from its sixth on, its samples from line 9.
std::string with_line(int line, const std::string& replacement) {
  std::string text = test::scattered_text(satin, 30, kFewWavelengths);
  std::size_t begin = 0;
  for (int i = 1; i < line; ++i) begin = text.find('\n', begin) + 1;
  return text.replace(begin, text.find('\n', begin) - begin, replacement);
}

Vec3 direction(double theta, double phi) {
  return {Float(std::sin(theta) * std::cos(phi)), Float(std::sin(theta) * std::sin(phi)),
          Float(std::cos(theta))};
}

TEST(ScatteredText, ReadsWhatWasWritten) {
  const ScatteredSamples s = parse_scattered(test::scattered_text(satin, 30, kFewWavelengths), "m.brdf");
  EXPECT_EQ(s.lambda_nm, (std::vector<float>{400, 500, 600, 700}));
  ASSERT_EQ(s.directions.size(), 30U);
  ASSERT_EQ(s.f.size(), 120U);
  for (std::size_t i = 0; i < 30; ++i) {
    const auto& d = s.directions[i];
    const double f = satin(direction(d.theta_o, d.phi_o), direction(d.theta_i, d.phi_i), 600);
    EXPECT_NEAR(double(s.f[i * 4 + 2]), f, 1e-5 * f + 1e-6);  // six decimals of the text
  }
}

TEST(ScatteredText, TakesHeadersOfOneLineOrMany) {
  const std::string one = with_line(7, "400 500\n600 # a comment\n700");
  EXPECT_EQ(parse_scattered(one, "m.brdf").lambda_nm.size(), 4U);
  EXPECT_TRUE(is_scattered_text(one));
  EXPECT_FALSE(is_scattered_text("# nothing\n"));
  EXPECT_FALSE(is_scattered_text("{\"a\": 1}"));
}

TEST(ScatteredText, NegativeValuesAreClampedAndCounted) {
  const ScatteredSamples s = parse_scattered(with_line(12, "0.1 0 0.2 0 -0.1 0.2 -1e-9 0"), "m.brdf");
  EXPECT_EQ(s.negative_values, 2U);
  EXPECT_TRUE(std::all_of(s.f.begin(), s.f.end(), [](float f) { return f >= 0; }));
}

TEST(ScatteredText, NamesLineAndColumnOfWhatIsWrong) {
  const auto expect = [](const std::string& text, const std::string& problem) {
    EXPECT_EQ(problem_of(text), "m.brdf:" + problem);
  };
  expect("", "1:1: expected the number of wavelengths, got nothing");
  expect(with_line(4, "x"), "4:1: expected a finite number, got \"x\"");
  expect(with_line(4, "2.5"),
         "4:1: expected the number of wavelengths, an integer in [1, 4096], got \"2.5\"");
  expect(with_line(4, "0"), "4:1: expected the number of wavelengths, an integer in [1, 4096], got \"0\"");
  expect(with_line(7, "400 500 600 700 800"), "7:17: expected 4 wavelengths, got one more");
  expect(with_line(7, "400 500 500 700"), "7:9: wavelengths must increase: 500 nm follows 500 nm");
  expect(with_line(7, "-4 500 600 700"), "7:1: expected a wavelength above 0 nm, got -4");
  expect(with_line(12, "0.1 0 0.2 0 1 2 3"),
         "12:17: 7 numbers on the line of a sample, expected 8: 4 angles and 4 values");
  expect(with_line(12, "0.1 0 0.2 0 1 2 3 4 5"),
         "12:21: 9 numbers on the line of a sample, expected 8: 4 angles and 4 values");
  expect(with_line(12, "45 0 0.2 0 1 2 3 4"), "12:1: theta_i is 45, expected radians in [0, pi/2]");
  expect(with_line(12, "0.1 0 -0.2 0 1 2 3 4"), "12:7: theta_o is -0.2, expected radians in [0, pi/2]");
  expect(with_line(12, "0.1 0 0.2 0 1 2 nan 4"), "12:17: expected a finite number, got \"nan\"");
  expect(with_line(12, "0.1 0 0.2 0 1 2 3 1e60"), "12:19: expected a finite number, got \"1e60\"");
  expect(with_line(12, "0.1 0 0.2 0 1 2 3 4x"), "12:19: expected a finite number, got \"4x\"");
  expect(test::scattered_text(satin, 12, kFewWavelengths), "21:1: 12 samples, expected more than 12");
}

TEST(ScatteredBrdf, CoordinatesKnowReciprocityAndMirrorSymmetry) {
  test::TestRandom random(5);
  for (int i = 0; i < 100; ++i) {
    const double a = 1.5 * double(random.uniform()), b = 1.5 * double(random.uniform()),
                 phi = 3 * double(random.uniform()), turn = 6 * double(random.uniform());
    const auto point = ScatteredBrdf::point_of(direction(a, 0), direction(b, phi));
    for (const auto& other : {ScatteredBrdf::point_of(direction(b, phi), direction(a, 0)),
                              ScatteredBrdf::point_of(direction(a, 0), direction(b, -phi)),
                              ScatteredBrdf::point_of(direction(a, turn), direction(b, phi + turn))}) {
      for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(other[k], point[k], 1e-3);  // √θh of single precision
    }
  }
}

TEST(ScatteredBrdf, AConstantComesBackExactly) {
  const ScatteredBrdf brdf(parse_scattered(
      test::scattered_text([](Vec3, Vec3, double) { return 0.25; }, 200, kFewWavelengths), "m.brdf"));
  test::TestRandom random(7);
  std::array<float, 4> v{};
  for (int i = 0; i < 500; ++i) {
    const Vec3 wi = direction(1.5 * double(random.uniform()), 0);
    brdf.read(direction(1.5 * double(random.uniform()), 6 * double(random.uniform())), wi, v);
    for (const float x : v) EXPECT_NEAR(x, 0.25F * wi.z, 1e-5);
  }
}

TEST(ScatteredBrdf, PredictsDirectionsItHasNotSeenAndKnowsWhereItCannot) {
  // As many samples as Cornell's files have.
  const ScatteredBrdf brdf(parse_scattered(test::scattered_text(satin, 1439, kFewWavelengths), "m.brdf"));
  test::TestRandom random(13);
  std::array<float, 4> v{};
  std::vector<double> known, filled;
  for (int i = 0; i < 5000; ++i) {
    const Vec3 wi = direction(1.4 * double(random.uniform()), 0),
               wo = direction(1.4 * double(random.uniform()), 6 * double(random.uniform()));
    const bool is_known = brdf.read(wo, wi, v);
    const double error = std::abs(double(v[1] / wi.z) / satin(wo, wi, 500) - 1);
    (is_known ? known : filled).push_back(error);
  }
  std::sort(known.begin(), known.end());
  std::sort(filled.begin(), filled.end());
  EXPECT_GT(known.size(), 3000U);
  EXPECT_GT(filled.size(), 200U);
  EXPECT_LT(known[known.size() / 2], 0.0022);        // observed 0.11 %
  EXPECT_LT(known[known.size() * 95 / 100], 0.011);  // observed 0.55 %
  EXPECT_GT(filled[filled.size() / 2], known[known.size() / 2]);
}

TEST(ScatteredBrdf, ConvertsToTablesThatSayWhatWasFilled) {
  const std::string text = test::scattered_text(satin, 400, kFewWavelengths);
  const MeasuredTables tables = measured_from_bytes(bytes_of(text), "folder/m.brdf");
  EXPECT_EQ(tables.axis.size(), 4U);
  EXPECT_EQ(tables.source.format, "Cornell text");
  EXPECT_EQ(tables.source.samples, 400U);
  EXPECT_GT(tables.source.filled_cells, 0U);
  // The last slice repeats the one before it.
  const auto invalid_above = [&] {
    std::size_t count = 0;
    for (std::size_t i = 0; i < tables.valid.size() / tables.theta_i.size() * (tables.theta_i.size() - 1);
         ++i) {
      count += tables.valid[i] == 0 && tables.luminance[i] > 0 ? 1U : 0U;
    }
    return count;
  }();
  EXPECT_EQ(invalid_above, tables.source.filled_cells);
}

TEST(ScatteredBrdf, CornellsOwnSamplesComeBack) {
  for (const char* name : {"acryl_blue", "cayman", "mystique"}) {
    const auto file = test::data_folder() / "cornell" / (std::string(name) + ".brdf");
    SPECTRACE_SKIP_WITHOUT(file);
    const std::vector<std::byte> bytes = read_file(file);
    const ScatteredSamples s =
        parse_scattered({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, file.string());
    EXPECT_EQ(s.lambda_nm.size(), 31U);
    EXPECT_EQ(s.directions.size(), 1439U);
    EXPECT_EQ(s.negative_values, 0U);
    const ScatteredBrdf brdf(s);
    std::vector<float> v(31);
    std::vector<double> errors;
    for (std::size_t i = 0; i < s.directions.size(); ++i) {
      const auto& d = s.directions[i];
      const Vec3 wi = direction(d.theta_i, d.phi_i);
      EXPECT_TRUE(brdf.read(direction(d.theta_o, d.phi_o), wi, v));
      for (std::size_t k = 0; k < 31; ++k) {
        // A thousandth is the noise of the instrument.
        errors.push_back(std::abs(std::log((double(v[k] / wi.z) + 1e-3) / (double(s.f[i * 31 + k]) + 1e-3))));
      }
    }
    std::sort(errors.begin(), errors.end());
    EXPECT_LT(errors[errors.size() / 2], 0.036) << name;      // observed 0.7, 1.4, 1.8 %
    EXPECT_LT(errors[errors.size() * 9 / 10], 0.28) << name;  // observed 14, 11, 11 %
  }
}

}  // namespace
}  // namespace spectrace
