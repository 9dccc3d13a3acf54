// SPDX-License-Identifier: Apache-2.0
#include "core/spectra/illuminants.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/spectra/cie_tables.h"
#include "core/spectra/color.h"
#include "tests/support/test_data.h"

namespace spectrace::test {
namespace {

struct Chromaticity {
  std::string_view name;
  double x, y;
};

// What the CIE prints of each (CIE 15:2004, tables T.3, T.8.1), from other sums than ours: 5 nm or 1 nm, to
// 780 nm.
TEST(Illuminants, HaveTheirPublishedChromaticity) {
  for (const auto& [name, x, y] : {Chromaticity{"A", 0.44758, 0.40745},
                                   {"D50", 0.34567, 0.35851},
                                   {"D55", 0.33243, 0.34744},
                                   {"D65", 0.31272, 0.32903},
                                   {"D75", 0.29903, 0.31488},
                                   {"E", 0.33333, 0.33333},
                                   {"F2", 0.37208, 0.37529},
                                   {"F7", 0.31292, 0.32933},
                                   {"F11", 0.38052, 0.37713}}) {
    const Xyz xyz = spectrum_to_xyz(named_illuminant(name));
    const double sum = xyz[0] + xyz[1] + xyz[2];
    EXPECT_NEAR(xyz[0] / sum, x, 2e-4) << name;
    EXPECT_NEAR(xyz[1] / sum, y, 2e-4) << name;
  }
}

TEST(Illuminants, DaylightIsOneAt560nmAndLampsHaveLuminanceOne) {
  for (std::string_view name : kIlluminantNames) {
    const Spectrum illuminant = named_illuminant(name);
    if (name[0] == 'F') {
      EXPECT_NEAR(spectrum_to_xyz(illuminant)[1], 1, 1e-6) << name;
    } else {
      EXPECT_NEAR(illuminant.at(560), 1, 1e-6) << name;
    }
  }
}

// D65 has a table of its own, which the CIE made from the same components.
TEST(Illuminants, DaylightOf6500KIsD65) {
  const TabulatedSpectrum d65 = daylight(6500);
  for (std::size_t i = 0; i < kD65Samples; ++i) {
    const auto nm = static_cast<Float>(kD65MinNm + kD65StepNm * static_cast<int>(i));
    // Printed to six digits; up to 2e-3 of 100 where T.2's three digits were not all that went in.
    EXPECT_NEAR(d65.at(nm), kD65[i] / 100, 1.5e-4) << nm;
  }
}

TEST(Illuminants, LampsHaveTheValuesOfTheSharedTables) {
  for (const char* name : {"F2", "F7", "F11"}) {
    const auto file = data_folder() / "spectra" / (std::string("cie.stdillum.") + name + ".spd");
    SPECTRACE_SKIP_WITHOUT(file);
    const TabulatedSpectrum published = read_spd(file, 1);
    const Spectrum ours = named_illuminant(name);
    const double unit = double(published.at(550)) / double(ours.at(550));
    for (std::size_t i = 0; i < published.values().size(); ++i) {
      const Float nm = published.lambda_nm()[i];
      EXPECT_NEAR(double(ours.at(nm)) * unit, published.values()[i], 1e-5 * unit) << name << ' ' << nm;
    }
  }
}

}  // namespace
}  // namespace spectrace::test
