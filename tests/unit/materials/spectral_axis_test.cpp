// SPDX-License-Identifier: Apache-2.0
#include "materials/spectral_axis.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "core/base/error.h"
#include "core/spectra/rgb_uplift.h"

namespace spectrace {
namespace {

SampledWavelengths at(Float lambda_nm) {
  std::array<Float, kLanes> lambda{}, pdf{};
  for (int i = 0; i < kLanes; ++i) lambda[i] = lambda_nm + i;
  pdf.fill(1);
  return {lambda, pdf};
}

/// Zigzag values, so that the wrong pair of neighbours shows: held against a walk along the axis.
void expect_interpolation(const SpectralAxis& axis) {
  const auto nodes = axis.lambda_nm();
  std::vector<float> row;
  for (std::size_t i = 0; i < nodes.size(); ++i) row.push_back(i % 2 == 0 ? 1.0f : 3.0f + 0.01f * float(i));
  const auto expected = [&](double lambda) {
    if (lambda <= nodes.front()) return double(row.front());
    for (std::size_t i = 1; i < nodes.size(); ++i) {
      if (lambda > nodes[i]) continue;
      const double t = (lambda - nodes[i - 1]) / (double(nodes[i]) - nodes[i - 1]);
      return row[i - 1] + t * (row[i] - row[i - 1]);
    }
    return double(row.back());
  };
  // Neighbours differ by at most 4 and are at least 0.2 nm apart; wavelengths near 400 nm round by 3e-5.
  constexpr double kTolerance = 4 * 3e-5 / 0.2;
  for (Float lambda = 300; lambda < 1100; lambda += Float(0.37)) {
    const SampledSpectrum value = axis.lookup(at(lambda)).apply(row.data());
    for (int i = 0; i < kLanes; ++i) EXPECT_NEAR(value[i], expected(lambda + i), kTolerance) << lambda;
  }
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    EXPECT_NEAR(axis.lookup(at(nodes[i])).apply(row.data())[0], row[i], 1e-6) << nodes[i];
  }
}

TEST(SpectralAxis, InterpolatesEqualAndUnequalSteps) {
  std::vector<float> equal, nearly, unequal;
  std::mt19937 random(3);
  for (int i = 0; i < 195; ++i) {
    equal.push_back(358.63f + 3.316f * i);
    nearly.push_back(equal.back() + 0.4f * (float(random() % 1000) / 500 - 1));
    unequal.push_back(360 + 0.02f * i * i);
  }
  unequal.erase(unequal.begin() + 1, unequal.begin() + 5);
  expect_interpolation(SpectralAxis::wavelengths(equal));
  expect_interpolation(SpectralAxis::wavelengths(nearly));
  expect_interpolation(SpectralAxis::wavelengths(unequal));
  expect_interpolation(SpectralAxis::wavelengths({500, 600}));
}

TEST(SpectralAxis, OneWavelengthIsGrey) {
  const SpectralAxis axis = SpectralAxis::wavelengths({550});
  const std::array<float, 3> row{0.25f, 1, 1};  // of which only the first is its own
  for (const Float lambda : {Float(300), Float(550), Float(900)}) {
    EXPECT_EQ(axis.lookup(at(lambda)).apply(row.data()), SampledSpectrum(Float(0.25)));
  }
}

TEST(SpectralAxis, RgbFollowsTheLinearBasis) {
  const SpectralAxis axis = SpectralAxis::rgb();
  EXPECT_EQ(axis.size(), 3u);
  const std::array<float, 3> row{0.2f, 3.0f, 0.5f};
  const SampledSpectrum value = axis.lookup(at(480)).apply(row.data());
  for (int i = 0; i < kLanes; ++i) {
    const auto basis = rgb_basis(Float(480 + i));
    EXPECT_FLOAT_EQ(value[i], basis[0] * row[0] + basis[1] * row[1] + basis[2] * row[2]);
  }
}

TEST(SpectralAxis, RefusesWavelengthsOutOfOrder) {
  EXPECT_THROW((void)SpectralAxis::wavelengths({500, 500}), InternalError);
  EXPECT_THROW((void)SpectralAxis::wavelengths({500, 400}), InternalError);
  EXPECT_THROW((void)SpectralAxis::wavelengths({}), InternalError);
}

}  // namespace
}  // namespace spectrace
