// SPDX-License-Identifier: Apache-2.0
#include "materials/measured_brdf.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "core/math/math.h"
#include "tests/support/measured_reference.h"
#include "tests/support/synthetic_measured.h"
#include "tests/support/test_data.h"

namespace spectrace {
namespace {

using test::make_measured;
using test::MeasuredReference;
using test::SyntheticMeasured;

/// What is asked of evaluation and of weights, at the 99th percentile of random direction pairs.
constexpr double kRelativeTolerance = 1e-4;
constexpr int kPairs = 100000;

class Directions {
 public:
  explicit Directions(unsigned seed) : random_(seed) {}
  double unit() { return unit_(random_); }
  Vec3 hemisphere() {  // uniform over solid angle
    const double z = 1 - unit(), phi = 2 * kPi64 * unit(), r = std::sqrt(std::max(0.0, 1 - z * z));
    return {Float(r * std::cos(phi)), Float(r * std::sin(phi)), Float(z)};
  }
  BsdfRandom numbers() { return {Float(unit()), {Float(unit()), Float(unit())}}; }
  SampledWavelengths wavelengths() {
    std::array<Float, kLanes> lambda{}, pdf{};
    for (Float& x : lambda) x = Float(360 + 470 * unit());
    pdf.fill(Float(1.0 / 470));
    return {lambda, pdf};
  }

 private:
  std::mt19937 random_;
  std::uniform_real_distribution<double> unit_{0, 1};
};

std::array<double, kLanes> nanometres(const SampledWavelengths& lambda) {
  std::array<double, kLanes> out{};
  for (int i = 0; i < kLanes; ++i) out[i] = lambda.lambda_nm(i);
  return out;
}

double relative_error(double value, double truth) {
  if (truth == 0) return value == 0 ? 0 : 1;
  return std::abs(value - truth) / truth;
}

double percentile_99(std::vector<double> errors) {
  const auto nth = errors.begin() + std::ptrdiff_t(errors.size() * 99 / 100);
  std::nth_element(errors.begin(), nth, errors.end());
  return *nth;
}

void expect_like_reference(const MeasuredTables& tables) {
  const MeasuredBrdf brdf(tables);
  const MeasuredReference reference(tables);
  Directions draw(5);
  std::vector<double> value_errors, pdf_errors;
  for (int i = 0; i < kPairs; ++i) {
    const Vec3 wo = draw.hemisphere(), wi = draw.hemisphere();
    const SampledWavelengths lambda = draw.wavelengths();
    const BsdfValue got = brdf.evaluate(wo, wi, {lambda});
    const auto truth = reference.evaluate(wo, wi, nanometres(lambda));
    double worst = 0;
    for (int lane = 0; lane < kLanes; ++lane) {
      ASSERT_TRUE(std::isfinite(got.value_cos[lane]) && got.value_cos[lane] >= 0);
      worst = std::max(worst, relative_error(got.value_cos[lane], truth.value_cos[lane]));
    }
    value_errors.push_back(worst);
    pdf_errors.push_back(relative_error(got.pdf, truth.pdf));
  }
  EXPECT_LE(percentile_99(value_errors), kRelativeTolerance);
  EXPECT_LE(percentile_99(pdf_errors), kRelativeTolerance);
}

/// sample() draws with the density evaluate() states, and weighs with the value it gives.
void expect_weights_fit(const MeasuredTables& tables) {
  const MeasuredBrdf brdf(tables);
  Directions draw(6);
  std::vector<double> weight_errors, pdf_errors;
  for (int i = 0; i < kPairs; ++i) {
    const Vec3 wo = draw.hemisphere();
    const SampledWavelengths lambda = draw.wavelengths();
    const auto sample = brdf.sample(wo, draw.numbers(), {lambda});
    if (!sample) continue;
    ASSERT_GT(sample->pdf, 0);
    ASSERT_TRUE(sample->weight.is_finite() && sample->weight.min() >= 0);
    const BsdfValue value = brdf.evaluate(wo, sample->wi, {lambda});
    pdf_errors.push_back(relative_error(sample->pdf, value.pdf));
    double worst = 0;
    for (int lane = 0; lane < kLanes; ++lane) {
      worst = std::max(worst, relative_error(sample->weight[lane], value.value_cos[lane] / value.pdf));
    }
    weight_errors.push_back(worst);
  }
  EXPECT_GT(weight_errors.size(), std::size_t(kPairs) / 2);
  EXPECT_LE(percentile_99(weight_errors), kRelativeTolerance);
  EXPECT_LE(percentile_99(pdf_errors), kRelativeTolerance);
}

std::vector<SyntheticMeasured> layouts() {
  return {{},
          {.rgb = true},
          {.jacobian = false},
          {.isotropic = false},
          {.isotropic = false, .first_phi_i = 0.4},
          {.isotropic = false, .symmetry = 2, .stored_reduction = 2},
          {.isotropic = false, .symmetry = 2, .stored_reduction = 2, .first_phi_i = 0.7, .rgb = true},
          {.isotropic = false, .symmetry = 4, .stored_reduction = 4},
          {.isotropic = false, .symmetry = 4, .stored_reduction = 4, .first_phi_i = kPi64 / 2}};
}

TEST(MeasuredBrdf, AgreesWithTheReferenceInEveryLayout) {
  for (const SyntheticMeasured& layout : layouts()) {
    SCOPED_TRACE(testing::Message() << "symmetry " << layout.symmetry << " from " << layout.first_phi_i);
    expect_like_reference(make_measured(layout));
  }
}

TEST(MeasuredBrdf, AgreesWithTheReferenceWhereLuminanceIsBlind) {
  MeasuredTables tables = make_measured({});
  for (std::size_t i = 0; i < tables.luminance.size(); i += 3) tables.luminance[i] = 0;
  expect_like_reference(tables);
}

TEST(MeasuredBrdf, WeightIsValueOverPdfInEveryLayout) {
  for (const SyntheticMeasured& layout : layouts()) {
    SCOPED_TRACE(testing::Message() << "symmetry " << layout.symmetry << " from " << layout.first_phi_i);
    expect_weights_fit(make_measured(layout));
  }
}

class MeasuredBrdfOfFolder : public testing::TestWithParam<const char*> {};

TEST_P(MeasuredBrdfOfFolder, AgreesWithTheReference) {
  const auto files = test::measured_files(GetParam());
  if (files.empty())
    GTEST_SKIP() << "needs " << GetParam() << " in " << test::data_folder() << " (set SPECTRACE_DATA)";
  for (const auto& file : files) {
    SCOPED_TRACE(file);
    expect_like_reference(read_measured(file));
  }
}

TEST_P(MeasuredBrdfOfFolder, WeightIsValueOverPdf) {
  const auto files = test::measured_files(GetParam());
  if (files.empty())
    GTEST_SKIP() << "needs " << GetParam() << " in " << test::data_folder() << " (set SPECTRACE_DATA)";
  for (const auto& file : files) {
    SCOPED_TRACE(file);
    expect_weights_fit(read_measured(file));
  }
}

INSTANTIATE_TEST_SUITE_P(Data, MeasuredBrdfOfFolder, testing::Values("epfl_rgb", "epfl_uplifted"),
                         [](const auto& param) { return std::string(param.param); });

}  // namespace
}  // namespace spectrace
