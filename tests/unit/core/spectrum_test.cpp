// SPDX-License-Identifier: Apache-2.0
#include "core/spectra/spectrum.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/math/math.h"
#include "core/spectra/color.h"
#include "core/spectra/rgb_uplift.h"
#include "tests/support/temporary_folder.h"

namespace spectrace {
namespace {

const SellmeierSpectrum kBk7{{Float(1.03961212), Float(0.231792344), Float(1.01046945)},
                             {Float(0.00600069867), Float(0.0200179144), Float(103.560653)}};

std::vector<Spectrum> one_of_each() {
  return {Spectrum::constant(Float(0.3)),
          TabulatedSpectrum({400, 410, 450, 700}, {1, 5, 2, 4}),
          BlackbodySpectrum{4000, Float(1e-4)},
          uplift_reflectance({0.8, 0.3, 0.1}),
          uplift_emission({2, 3, 0.5}),
          kBk7,
          CauchySpectrum{Float(1.5046), Float(0.0042), Float(1e-5)}};
}

TEST(Spectrum, TabulatedIsLinearAndHoldsItsEnds) {  // hard case H13: 300 and 1100 nm
  const TabulatedSpectrum uneven({400, 500, 520}, {1, 3, 0});
  EXPECT_FLOAT_EQ(uneven.at(450), 2);
  EXPECT_FLOAT_EQ(uneven.at(500), 3);
  EXPECT_FLOAT_EQ(uneven.at(510), 1.5);
  EXPECT_EQ(uneven.at(300), 1);
  EXPECT_EQ(uneven.at(1100), 0);
  EXPECT_EQ(uneven.at(std::nanf("")), 1) << "not an index out of the table";
  EXPECT_EQ(TabulatedSpectrum({550}, {7}).at(400), 7) << "one wavelength is a constant";
}

TEST(Spectrum, EqualStepsGiveWhatTheSearchGives) {
  // 195 wavelengths of the EPFL database: equal steps, rounded.
  std::vector<Float> nm, values, nm_uneven, values_uneven;
  for (int i = 0; i < 195; ++i) {
    nm.push_back(Float(358.63) + Float(i) * Float(1001.89 - 358.63) / 194);
    values.push_back(std::sin(Float(i)));
  }
  nm_uneven = nm;
  values_uneven = values;
  nm_uneven.push_back(1002);  // one short step at the end forces the search
  values_uneven.push_back(0);
  const TabulatedSpectrum even(nm, values), searched(nm_uneven, values_uneven);
  for (int i = 0; i < 20000; ++i) {
    const Float at = 350 + Float(i) * Float(0.0325);
    ASSERT_EQ(even.at(at), searched.at(at)) << at;
  }
  for (const Float at : nm) ASSERT_EQ(even.at(at), searched.at(at)) << at;
}

TEST(Spectrum, TablesThatAreNoneAreRefused) {
  const Float inf = std::numeric_limits<Float>::infinity();
  EXPECT_THROW(TabulatedSpectrum({}, {}), InternalError);
  EXPECT_THROW(TabulatedSpectrum({400, 500}, {1}), InternalError);
  EXPECT_THROW(TabulatedSpectrum({400, 400}, {1, 1}), InternalError);
  EXPECT_THROW(TabulatedSpectrum({500, 400}, {1, 1}), InternalError);
  EXPECT_THROW(TabulatedSpectrum({400, 500}, {1, inf}), InternalError);
}

TEST(Spectrum, BlackbodyObeysPlanckWienAndStefanBoltzmann) {
  // 2 h c² / λ⁵ / (exp(h c / λ k T) - 1), worked out by hand to 5 digits for 500 nm and 5000 K.
  EXPECT_NEAR(BlackbodySpectrum{5000}.at(500), 12107, 1);
  for (const Float kelvin : {1000.0f, 2856.0f, 6504.0f, 20000.0f}) {
    const BlackbodySpectrum body{kelvin};
    double integral = 0, peak = 0, peak_nm = 0;
    const double end_nm = 4e9 / kelvin * 10;  // 40 000 µm·K holds all but 4e-4 of it
    const int n = 200000;
    for (int i = 0; i < n; ++i) {
      const double nm = end_nm * (i + 0.5) / n;
      const double radiance = body.at(static_cast<Float>(nm));
      integral += radiance * end_nm / n;
      if (radiance > peak) {
        peak = radiance;
        peak_nm = nm;
      }
    }
    const double sigma = 5.670374419e-8, wien_nm_kelvin = 2.897771955e6;  // CODATA 2018
    EXPECT_NEAR(integral / (sigma * std::pow(double(kelvin), 4) / kPi64), 1, 6e-4);
    EXPECT_NEAR(peak_nm * kelvin / wien_nm_kelvin, 1, 1e-3);  // a float is flat over the peak that far
  }
  EXPECT_EQ(BlackbodySpectrum{3000}.at(1), 0) << "underflows, does not overflow";
}

TEST(Spectrum, SellmeierGivesBk7) {
  EXPECT_NEAR(kBk7.at(Float(587.5618)), 1.51680, 5e-6);  // Schott's catalogue: n_d, n_F, n_C
  EXPECT_NEAR(kBk7.at(Float(486.1327)), 1.52238, 5e-6);
  EXPECT_NEAR(kBk7.at(Float(656.2725)), 1.51432, 5e-6);
}

TEST(Spectrum, CauchyIsAPolynomialOfTheInverseSquareInMicrometres) {
  const CauchySpectrum s{.a = Float(1.5), .b_um2 = Float(0.01), .c_um4 = Float(0.001), .scale = 2};
  EXPECT_NEAR(s.at(500), 2 * (1.5 + 0.01 * 4 + 0.001 * 16), 1e-6);
  EXPECT_NEAR(s.at(1000), 2 * (1.5 + 0.01 + 0.001), 1e-6);
}

TEST(Spectrum, CauchyThroughThreeLinesGivesBk7Between) {
  // Fitted to n_d, n_F, n_C of the catalogue; its n_e at 546.074 nm is 1.51872.
  const double x[3] = {1 / (0.5875618 * 0.5875618), 1 / (0.4861327 * 0.4861327), 1 / (0.6562725 * 0.6562725)};
  const double y[3] = {1.51680, 1.52238, 1.51432};
  const double first = (y[1] - y[0]) / (x[1] - x[0]), second = (y[2] - y[0]) / (x[2] - x[0]);
  const double c = (first - second) / (x[1] - x[2]), b = first - c * (x[0] + x[1]);
  const CauchySpectrum s{static_cast<Float>(y[0] - (b + c * x[0]) * x[0]), static_cast<Float>(b),
                         static_cast<Float>(c)};
  EXPECT_NEAR(s.at(Float(546.074)), 1.51872, 2e-5);  // 2e-5: the catalogue's last digit, thrice over
}

TEST(Spectrum, SellmeierIsOneWhereTheSumIsNegativeOrAtAPole) {
  const SellmeierSpectrum pole{{1, 0, 0}, {Float(0.25), 0, 0}};
  EXPECT_EQ(pole.at(499), 1);
  EXPECT_EQ(pole.at(500), 1);
  EXPECT_GT(pole.at(501), 1);
}

TEST(Spectrum, SigmoidKeepsItsDigitsWhereItIsSmall) {
  // S(x) = 1 / (4 x²) for large -x: 1/2 + x / (2 sqrt(1 + x²)) would be 0 or a multiple of 6e-8 here.
  EXPECT_NEAR((SigmoidSpectrum{{0, 0, -5000}}).at(500) / 1e-8f, 1, 1e-6);
  EXPECT_EQ((SigmoidSpectrum{{0, 0, 0}, 4}).at(500), 2);
}

TEST(Spectrum, SampleAgreesWithAt) {
  const SampledWavelengths lambda = WavelengthDistribution::visible({}).sample(Float(0.17));
  for (const Spectrum& s : one_of_each()) {
    const SampledSpectrum sampled = s.sample(lambda);
    for (int i = 0; i < kLanes; ++i) EXPECT_EQ(sampled[i], s.at(lambda.lambda_nm(i)));
  }
}

TEST(Spectrum, ScalingIsLinear) {
  for (const Spectrum& s : one_of_each()) {
    const Spectrum scaled = s.scaled(Float(2.5));
    for (const Float nm : {380.f, 455.f, 620.f, 900.f})
      EXPECT_NEAR(scaled.at(nm) / (s.at(nm) * Float(2.5)), 1, 1e-6);
    EXPECT_EQ(s.scaled(0).at(500), 0);
  }
}

TEST(Spectrum, OnlyConstantsAreConstant) {
  EXPECT_TRUE(Spectrum::constant(3).is_constant());
  EXPECT_TRUE(Spectrum(TabulatedSpectrum({400, 500}, {2, 2})).is_constant());
  EXPECT_TRUE(Spectrum(uplift_reflectance({0.4, 0.4, 0.4})).is_constant());
  EXPECT_TRUE(Spectrum(SellmeierSpectrum{}).is_constant());
  EXPECT_TRUE(Spectrum(CauchySpectrum{.a = Float(1.5)}).is_constant());
  for (std::size_t i = 1; i < one_of_each().size(); ++i) EXPECT_FALSE(one_of_each()[i].is_constant()) << i;
}

TEST(Spectrum, MaximumBoundsEveryValue) {
  for (const Spectrum& s : one_of_each()) {
    const WavelengthRange range{.min_nm = Float(380.5), .max_nm = Float(733.3)};
    const double bound = s.max_over(range);
    for (Float nm = range.min_nm; nm <= range.max_nm; nm += Float(0.037)) {
      EXPECT_LE(s.at(nm), bound * (1 + 1e-4));  // to 1 nm, as promised; the smooth ones bend that little
    }
  }
  // A peak narrower than the steps; one outside the range does not count.
  const TabulatedSpectrum peaks({500, Float(500.1), Float(500.2), 600, 601, 602}, {0, 9, 0, 0, 99, 0});
  EXPECT_EQ(Spectrum(peaks).max_over({.min_nm = 400, .max_nm = 600}), 9);
}

TEST(SpdFile, ReadsColumnsCommentsAndSeparators) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "a.spd";
  test::write_text(file, "# nm  eta k\n400 1 10\r\n\n 410.5,2e0\t-20 # there\n500\t3 +30");
  EXPECT_THROW((void)read_spd(file, 3), InputError);
  EXPECT_EQ(read_spd(file).values()[1], 2);
  EXPECT_EQ(read_spd(file, 2).values()[1], -20);
  EXPECT_EQ(read_spd(file).lambda_nm()[1], 410.5f);
  EXPECT_EQ(read_spd(file).values().size(), 3u);
}

TEST(SpdFile, NamesLineAndColumnOfEveryFault) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "bad.spd";
  const struct {
    const char* text;
    const char* where;
    const char* problem;
  } cases[] = {
      {"400 1\n500 2\n500 3\n", "3:1", "wavelengths must increase: 500 nm follows 500 nm"},
      {"500 1\n  400 2\n", "2:3", "wavelengths must increase: 400 nm follows 500 nm"},
      {"# x\n400 1\n500 x1\n", "3:5", "expected a finite number, got \"x1\""},
      {"400 1\n500 2nm\n", "2:5", "expected a finite number, got \"2nm\""},
      {"400 1\n500 nan\n", "2:5", "expected a finite number, got \"nan\""},
      {"400 1e400\n", "1:5", "expected a finite number, got \"1e400\""},
      {"400 1e300\n", "1:5", "expected a finite number, got \"1e300\""},
      {"400 1\n500\n", "2:4", "expected a wavelength and 1 value, got 1 column"},
      {"-4 1\n", "1:1", "expected a wavelength above 0 nm, got -4"},
      {"# nothing\n", "", "holds no wavelength"},
  };
  for (const auto& c : cases) {
    test::write_text(file, c.text);
    try {
      (void)read_spd(file);
      ADD_FAILURE() << "accepted: " << c.text;
    } catch (const InputError& e) {
      EXPECT_EQ(e.diagnostics().front().file, file.string());
      EXPECT_EQ(e.diagnostics().front().where, c.where) << c.text;
      EXPECT_EQ(e.diagnostics().front().problem, c.problem) << c.text;
    }
  }
}

}  // namespace
}  // namespace spectrace
