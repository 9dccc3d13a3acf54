// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/spectra/color.h"
#include "core/spectra/rgb_uplift.h"
#include "core/spectra/sigmoid_fit.h"
#include "core/spectra/uplift_table.h"
#include "tests/support/chi_square.h"

namespace spectrace {
namespace {

double distance(const Rgb& a, const Rgb& b) {
  double worst = 0;
  for (std::size_t c = 0; c < 3; ++c) worst = std::max(worst, std::abs(a[c] - b[c]));
  return worst;
}
double round_trip_error(const Spectrum& reflectance, const Rgb& rgb) {
  return distance(xyz_to_rgb(reflectance_to_xyz(reflectance)), rgb);
}

/// n³ colours, 0 and 1 included.
std::vector<Rgb> cube(int n) {
  std::vector<Rgb> all;
  for (int i = 0; i < n * n * n; ++i) {
    all.push_back({double(i % n) / (n - 1), double(i / n % n) / (n - 1), double(i / (n * n)) / (n - 1)});
  }
  return all;
}

TEST(Uplift, EveryColourOfTheCubeComesBack) {
  // All of sRGB is within reach of the sigmoids. What remains is what a float holds of a steep one.
  for (const Rgb& rgb : cube(9)) {
    EXPECT_LT(round_trip_error(uplift_reflectance(rgb), rgb), 1e-6)
        << rgb[0] << " " << rgb[1] << " " << rgb[2];
  }
}

TEST(Uplift, ReflectancesStayInTheUnitInterval) {
  for (const Rgb& rgb : cube(4)) {
    for (const SigmoidSpectrum& s : {uplift_reflectance(rgb), uplift_reflectance_fast(rgb)}) {
      for (int nm = 300; nm <= 1100; nm += 10) {
        EXPECT_GE(s.at(Float(nm)), 0);
        EXPECT_LE(s.at(Float(nm)), 1);
      }
    }
  }
}

TEST(Uplift, GreysAreFlatUpToWhiteAndBlack) {
  for (const double grey : {0.0, 1e-6, 0.18, 0.5, 0.999, 1.0}) {
    for (const SigmoidSpectrum& s :
         {uplift_reflectance({grey, grey, grey}), uplift_reflectance_fast({grey, grey, grey})}) {
      for (const Float nm : {360.f, 555.f, 830.f}) EXPECT_NEAR(s.at(nm), grey, 1e-7);
    }
  }
}

TEST(Uplift, ColoursOutsideAreClampedFirst) {
  const SigmoidSpectrum a = uplift_reflectance({-0.5, 0.25, 3}), b = uplift_reflectance({0, 0.25, 1});
  EXPECT_EQ(a.c, b.c);
  EXPECT_LT(round_trip_error(uplift_reflectance({std::nan(""), 0.25, 1}), {0, 0.25, 1}), 1e-6);
}

TEST(Uplift, ComplementsAreNegatedCoefficients) {
  // S(-x) = 1 - S(x) and white is white: what the table builds on.
  const SigmoidFitter fitter(1);
  const auto a = fitter.fit({0.7, 0.2, 0.4}), b = fitter.fit({0.3, 0.8, 0.6});
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(a.c[i], -b.c[i], 1e-7);
}

TEST(Uplift, TableIsWithinItsBound) {
  // Uniform colours, dark ones, and ones on the faces of the cube, where the coefficients bend most.
  test::TestRandom random(3);
  double worst = 0, sum = 0;
  const int n = 4000;
  for (int i = 0; i < n; ++i) {
    Rgb rgb{random.uniform(), random.uniform(), random.uniform()};
    const auto channel = static_cast<std::size_t>(i / 4 % 3);
    if (i % 4 == 1) rgb = {std::pow(rgb[0], 4), std::pow(rgb[1], 4), std::pow(rgb[2], 4)};
    if (i % 4 == 2) rgb[channel] = 0;
    if (i % 4 == 3) rgb[channel] = 1;
    const double error = round_trip_error(uplift_reflectance_fast(rgb), rgb);
    worst = std::max(worst, error);
    sum += error;
  }
  EXPECT_LT(worst, 2e-3);
  EXPECT_LT(sum / n, 5e-4);
  RecordProperty("worst", std::to_string(worst));
  RecordProperty("mean", std::to_string(sum / n));
}

TEST(Uplift, TableIsExactAtItsCorners) {
  for (const Rgb& rgb :
       {Rgb{1, 0, 0}, Rgb{0, 1, 0}, Rgb{0, 0, 1}, Rgb{1, 1, 0}, Rgb{0, 1, 1}, Rgb{1, 0, 1}}) {
    // The darkest and most saturated corners bend most between nodes; on a node only float rounding is left.
    EXPECT_LT(round_trip_error(uplift_reflectance_fast(rgb), rgb), 1e-5);
  }
}

TEST(Uplift, TableIsContinuousAcrossItsPieces) {
  // Where the largest channel changes, and where colours pass to their complements.
  const double h = 1e-9;
  for (const double x : {0.05, 0.3, 0.6, 0.9}) {
    const Rgb pairs[][2] = {{{x + h, x, 0.02}, {x, x + h, 0.02}},
                            {{x, 0.02, x + h}, {x + h, 0.02, x}},
                            {{x, 1 - x - h, 0.5}, {x, 1 - x + h, 0.5}}};
    for (const auto& [a, b] : pairs) {
      const Rgb at_a = xyz_to_rgb(reflectance_to_xyz(uplift_reflectance_fast(a)));
      const Rgb at_b = xyz_to_rgb(reflectance_to_xyz(uplift_reflectance_fast(b)));
      EXPECT_LT(distance(at_a, at_b), 2e-3);  // two interpolations of the same colour, each within its bound
    }
  }
}

TEST(Uplift, EmissionHasItsColourAndWhiteIsD65) {
  const RgbIlluminantSpectrum white = uplift_emission({1, 1, 1});
  EXPECT_LT(distance(xyz_to_rgb(spectrum_to_xyz(white)), {1, 1, 1}), 1e-6);
  for (const Float nm : {400.f, 500.f, 700.f}) {
    EXPECT_NEAR(white.at(nm) / white.at(560), illuminant_d65(nm), 1e-6);
  }
  for (const Rgb& rgb :
       {Rgb{1, 0, 0}, Rgb{0, 0.5, 0}, Rgb{3, 2, 1}, Rgb{1e-6, 2e-6, 3e-6}, Rgb{1e6, 1e5, 0}}) {
    const double scale = *std::max_element(rgb.begin(), rgb.end());
    EXPECT_LT(distance(xyz_to_rgb(spectrum_to_xyz(uplift_emission(rgb))), rgb) / scale, 1e-6);
    EXPECT_LT(distance(xyz_to_rgb(spectrum_to_xyz(uplift_emission_fast(rgb))), rgb) / scale, 4e-3);
  }
  EXPECT_LT(distance(xyz_to_rgb(spectrum_to_xyz(uplift_emission({-1, 1, 0}))), {0, 1, 0}), 1e-6);
  EXPECT_EQ(uplift_emission({0, 0, 0}).at(500), 0);
  EXPECT_EQ(uplift_emission_fast({0, -1, 0}).at(500), 0);
}

/// A basis spectrum as it is, for reflectance_to_xyz(): it is linear between nodes every 5 nm.
Spectrum basis_spectrum(std::size_t channel) {
  std::vector<Float> nm, values;
  for (int i = 360; i <= 830; i += 5) {
    nm.push_back(Float(i));
    values.push_back(rgb_basis(Float(i))[channel]);
  }
  return TabulatedSpectrum(nm, values);
}

TEST(RgbBasis, HasTheColoursOfThePrimaries) {
  for (std::size_t channel = 0; channel < 3; ++channel) {
    Rgb primary{};
    primary[channel] = 1;
    EXPECT_LT(round_trip_error(basis_spectrum(channel), primary), 2e-7) << channel;  // a float's rounding
  }
}

TEST(RgbBasis, IsNonNegativeAndSumsToOneEverywhere) {
  for (Float nm = 250; nm < 1100; nm += Float(0.71)) {
    const auto b = rgb_basis(nm);
    for (const Float x : b) EXPECT_GE(x, 0) << nm;
    EXPECT_NEAR(b[0] + b[1] + b[2], 1, 3e-7) << nm;
  }
}

TEST(RgbBasis, IsSmooth) {
  // 5 nm steps: at most 0.14 from node to node, and the slope turns by at most 0.04.
  for (int nm = 365; nm <= 825; nm += 5) {
    for (std::size_t c = 0; c < 3; ++c) {
      const double before = rgb_basis(Float(nm - 5))[c], here = rgb_basis(Float(nm))[c],
                   after = rgb_basis(Float(nm + 5))[c];
      EXPECT_LT(std::abs(after - here), 0.14) << nm;
      EXPECT_LT(std::abs(after - 2 * here + before), 0.04) << nm;
    }
  }
}

}  // namespace
}  // namespace spectrace
