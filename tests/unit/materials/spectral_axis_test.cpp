// SPDX-License-Identifier: Apache-2.0
#include "materials/spectral_axis.h"

#include <gtest/gtest.h>

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

/// Linear in wavelength: interpolation must reproduce it, whatever the spacing.
void expect_linear(const SpectralAxis& axis) {
  std::vector<float> row;
  for (const float lambda : axis.lambda_nm()) row.push_back(2 * lambda - 100);
  const Float first = axis.lambda_nm().front(), last = axis.lambda_nm().back();
  for (Float lambda = 300; lambda < 1100; lambda += Float(0.37)) {
    const SampledSpectrum value = axis.lookup(at(lambda)).apply(row.data());
    for (int i = 0; i < kLanes; ++i) {
      const Float expected = 2 * std::clamp<Float>(lambda + i, first, last) - 100;
      EXPECT_NEAR(value[i], expected, 1e-6 * 2000) << lambda;  // a few float roundings of 2000
    }
  }
  for (const float lambda : axis.lambda_nm()) {
    EXPECT_NEAR(axis.lookup(at(lambda)).apply(row.data())[0], 2 * lambda - 100, 1e-6 * 2000);
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
  expect_linear(SpectralAxis::wavelengths(equal));
  expect_linear(SpectralAxis::wavelengths(nearly));
  expect_linear(SpectralAxis::wavelengths(unequal));
  expect_linear(SpectralAxis::wavelengths({500, 600}));
}

TEST(SpectralAxis, OneWavelengthIsGrey) {
  const SpectralAxis axis = SpectralAxis::wavelengths({550});
  const float row = 0.25f;
  for (const Float lambda : {Float(300), Float(550), Float(900)}) {
    EXPECT_EQ(axis.lookup(at(lambda)).apply(&row), SampledSpectrum(Float(0.25)));
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
