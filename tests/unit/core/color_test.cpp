// SPDX-License-Identifier: Apache-2.0
#include "core/spectra/color.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <string>

#include "core/base/json.h"
#include "tests/support/test_data.h"

namespace spectrace {
namespace {

using test::data_folder;

std::array<double, 2> chromaticity(const Xyz& c) {
  const double sum = c[0] + c[1] + c[2];
  return {c[0] / sum, c[1] / sum};
}

TEST(Color, ObserverIntegratesToItsPublishedArea) {
  EXPECT_NEAR(cie_y_integral(), 106.857, 5e-4);  // CIE 15, to the digits given
  EXPECT_EQ(cie_xyz_bar(555)[1], 1);
  EXPECT_EQ(cie_xyz_bar(359.99), Xyz{});
  EXPECT_EQ(cie_xyz_bar(830.01), Xyz{});
  EXPECT_EQ(cie_xyz_bar(std::nan("")), Xyz{});
  EXPECT_NEAR(cie_xyz_bar(440.5)[2], (cie_xyz_bar(440)[2] + cie_xyz_bar(441)[2]) / 2, 1e-15);
}

TEST(Color, ObserverIsTheOneOfTheSharedData) {
  const auto file = data_folder() / "spectra/cmf_1931.json";
  SPECTRACE_SKIP_WITHOUT(file);
  JsonDocument document = JsonDocument::load(file);
  const JsonValue main = document.root().get("spectral_data").get("data").get("main");
  int compared = 0;
  for (const std::string& key : main.keys()) {
    const std::vector<double> theirs = main.get(key).numbers(3, 3);
    const Xyz ours = cie_xyz_bar(std::stod(key));
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(ours[c], theirs[c], 1e-15) << key;
    ++compared;
  }
  EXPECT_EQ(compared, 471);
}

TEST(Color, IlluminantsAreThoseOfTheSharedData) {
  using Named = std::pair<const char*, double (*)(double)>;
  for (const auto& [name, illuminant] : {Named{"D6500", illuminant_d65}, Named{"A", illuminant_a}}) {
    const auto file = data_folder() / "spectra" / (std::string("cie.stdillum.") + name + ".spd");
    SPECTRACE_SKIP_WITHOUT(file);
    const TabulatedSpectrum theirs = read_spd(file);
    for (std::size_t i = 0; i < theirs.values().size(); ++i) {
      // Six digits are what the file holds.
      EXPECT_NEAR(illuminant(theirs.lambda_nm()[i]) * 100, theirs.values()[i], 6e-6 * theirs.values()[i])
          << name << " at " << theirs.lambda_nm()[i];
    }
    EXPECT_GT(theirs.values().size(), 90u);
  }
}

TEST(Color, IlluminantsHaveTheirPublishedChromaticities) {
  // CIE 15:2004, table 11.3; D65 by 1 nm instead of 5 nm moves the last digit.
  const auto under = [](double (*illuminant)(double)) {
    return chromaticity(reflectance_to_xyz(Spectrum::constant(1), illuminant));
  };
  EXPECT_NEAR(under(illuminant_d65)[0], 0.31272, 1.5e-5);
  EXPECT_NEAR(under(illuminant_d65)[1], 0.32903, 1.5e-5);
  EXPECT_NEAR(under(illuminant_a)[0], 0.44758, 1.5e-5);
  EXPECT_NEAR(under(illuminant_a)[1], 0.40745, 1.5e-5);
}

TEST(Color, ConstantRadianceHasUnitLuminance) {
  const Xyz e = spectrum_to_xyz(Spectrum::constant(1));
  EXPECT_NEAR(e[1], 1, 1e-14);
  EXPECT_NEAR(chromaticity(e)[0], 1.0 / 3, 5e-5);  // the observer's own imbalance
  EXPECT_NEAR(chromaticity(e)[1], 1.0 / 3, 5e-5);
}

TEST(Color, ARangeCountsOnlyItsOwnPart) {
  const Spectrum one = Spectrum::constant(1);
  const Xyz whole = spectrum_to_xyz(one);
  const Xyz low = spectrum_to_xyz(one, {.min_nm = 300, .max_nm = 555}),
            high = spectrum_to_xyz(one, {.min_nm = 555, .max_nm = 1000});
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(low[c] + high[c], whole[c], 1e-5);  // the step at 360 nm
  EXPECT_EQ(spectrum_to_xyz(one, {.min_nm = 900, .max_nm = 1000})[1], 0);
}

TEST(Color, WhiteIsExactlyNeutral) {
  const Rgb white = xyz_to_rgb(reflectance_to_xyz(Spectrum::constant(1)));
  for (const double c : white) EXPECT_NEAR(c, 1, 1e-14);
}

TEST(Color, MatricesAreInverse) {
  for (const Rgb& rgb : {Rgb{1, 0, 0}, Rgb{0, 1, 0}, Rgb{0, 0, 1}, Rgb{-3, 0.2, 1e6}}) {
    const Rgb back = xyz_to_rgb(rgb_to_xyz(rgb));
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(back[c], rgb[c], 1e-15 * 1e6);
  }
}

TEST(Color, MatrixIsTheStandardsToItsWhite) {
  // IEC 61966-2-1, four digits, made for a white of (0.9505, 1, 1.0890).
  const double standard[3][3] = {
      {0.4124, 0.2126, 0.0193}, {0.3576, 0.7152, 0.1192}, {0.1805, 0.0722, 0.9505}};
  for (std::size_t i = 0; i < 3; ++i) {
    Rgb rgb{};
    rgb[i] = 1;
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(rgb_to_xyz(rgb)[c], standard[i][c], 3e-4);
  }
}

TEST(Color, TransferCurveRoundTripsAndIsContinuous) {
  for (const double x : {0.0, 0.001, 0.0031308, 0.0031309, 0.18, 0.5, 1.0}) {
    EXPECT_NEAR(srgb_decode(srgb_encode(x)), x, 3e-8);  // the standard's two branches meet to 1e-8
  }
  EXPECT_NEAR(srgb_encode(0.5), 0.735357, 1e-6);
  EXPECT_EQ(srgb_encode(-1), 0);
  EXPECT_NEAR(srgb_encode(2), 1, 1e-15);
}

}  // namespace
}  // namespace spectrace
