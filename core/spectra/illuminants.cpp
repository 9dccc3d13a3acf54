// SPDX-License-Identifier: Apache-2.0
#include "core/spectra/illuminants.h"

#include <array>
#include <cmath>
#include <vector>

#include "core/base/error.h"
#include "core/spectra/cie_tables.h"
#include "core/spectra/color.h"

namespace spectrace {

namespace {

// clang-format off
// Components of daylight, 300 nm to 830 nm by 10 nm; between them the CIE interpolates linearly (CIE 15:2004,
// table T.2).
constexpr int kDaylightMinNm = 300, kDaylightStepNm = 10;
constexpr std::size_t kDaylightSamples = 54;
constexpr std::array<double, kDaylightSamples> kDaylight0{
    .04, 6, 29.6, 55.3, 57.3, 61.8, 61.5, 68.8, 63.4, 65.8, 94.8, 104.8, 105.9, 96.8, 113.9, 125.6, 125.5, 121.3,
    121.3, 113.5, 113.1, 110.8, 106.5, 108.8, 105.3, 104.4, 100, 96, 95.1, 89.1, 90.5, 90.3, 88.4, 84, 85.1, 81.9,
    82.6, 84.9, 81.3, 71.9, 74.3, 76.4, 63.3, 71.7, 77, 65.2, 47.7, 68.6, 65, 66, 61, 53.3, 58.9, 61.9,
};
constexpr std::array<double, kDaylightSamples> kDaylight1{
    .02, 4.5, 22.4, 42, 40.6, 41.6, 38, 42.4, 38.5, 35, 43.4, 46.3, 43.9, 37.1, 36.7, 35.9, 32.6, 27.9, 24.3, 20.1,
    16.2, 13.2, 8.6, 6.1, 4.2, 1.9, 0, -1.6, -3.5, -3.5, -5.8, -7.2, -8.6, -9.5, -10.9, -10.7, -12, -14, -13.6, -12,
    -13.3, -12.9, -10.6, -11.6, -12.2, -10.2, -7.8, -11.2, -10.4, -10.6, -9.7, -8.3, -9.3, -9.8,
};
constexpr std::array<double, kDaylightSamples> kDaylight2{
    0, 2, 4, 8.5, 7.8, 6.7, 5.3, 6.1, 3, 1.2, -1.1, -.5, -.7, -1.2, -2.6, -2.9, -2.8, -2.6, -2.6, -1.8, -1.5, -1.3,
    -1.2, -1, -.5, -.3, 0, .2, .5, 2.1, 3.2, 4.1, 4.7, 5.1, 6.7, 7.3, 8.6, 9.8, 10.2, 8.3, 9.6, 8.5, 7, 7.6, 8, 6.7,
    5.2, 7.4, 6.8, 7, 6.4, 5.5, 6.1, 6.5,
};
// Fluorescent lamps, 380 nm to 780 nm by 5 nm (CIE 15:2004, table T.6.1): a standard one, one of broad bands
// and one of three narrow bands.
constexpr int kFluorescentMinNm = 380, kFluorescentStepNm = 5;
constexpr std::size_t kFluorescentSamples = 81;
constexpr std::array<double, kFluorescentSamples> kF2{
    1.18, 1.48, 1.84, 2.15, 3.44, 15.69, 3.85, 3.74, 4.19, 4.62, 5.06, 34.98, 11.81, 6.27, 6.63, 6.93, 7.19, 7.4,
    7.54, 7.62, 7.65, 7.62, 7.62, 7.45, 7.28, 7.15, 7.05, 7.04, 7.16, 7.47, 8.04, 8.88, 10.01, 24.88, 16.64, 14.59,
    16.16, 17.56, 18.62, 21.47, 22.79, 19.29, 18.66, 17.73, 16.54, 15.21, 13.8, 12.36, 10.95, 9.65, 8.4, 7.32, 6.31,
    5.43, 4.68, 4.02, 3.45, 2.96, 2.55, 2.19, 1.89, 1.64, 1.53, 1.27, 1.1, .99, .88, .76, .68, .61, .56, .54, .51,
    .47, .47, .43, .46, .47, .4, .33, .27,
};
constexpr std::array<double, kFluorescentSamples> kF7{
    2.56, 3.18, 3.84, 4.53, 6.15, 19.37, 7.37, 7.05, 7.71, 8.41, 9.15, 44.14, 17.52, 11.35, 12, 12.58, 13.08, 13.45,
    13.71, 13.88, 13.95, 13.93, 13.82, 13.64, 13.43, 13.25, 13.08, 12.93, 12.78, 12.6, 12.44, 12.33, 12.26, 29.52,
    17.05, 12.44, 12.58, 12.72, 12.83, 15.46, 16.75, 12.83, 12.67, 12.45, 12.19, 11.89, 11.6, 11.35, 11.12, 10.95,
    10.76, 10.42, 10.11, 10.04, 10.02, 10.11, 9.87, 8.65, 7.27, 6.44, 5.83, 5.41, 5.04, 4.57, 4.12, 3.77, 3.46,
    3.08, 2.73, 2.47, 2.25, 2.06, 1.9, 1.75, 1.62, 1.54, 1.45, 1.32, 1.17, .99, .81,
};
constexpr std::array<double, kFluorescentSamples> kF11{
    .91, .63, .46, .37, 1.29, 12.68, 1.59, 1.79, 2.46, 3.33, 4.49, 33.94, 12.13, 6.95, 7.19, 7.12, 6.72, 6.13, 5.46,
    4.79, 5.66, 14.29, 14.96, 8.97, 4.72, 2.33, 1.47, 1.1, .89, .83, 1.18, 4.9, 39.59, 72.84, 32.61, 7.52, 2.83,
    1.96, 1.67, 4.43, 11.28, 14.76, 12.73, 9.74, 7.33, 9.72, 55.27, 42.58, 13.18, 13.16, 12.26, 5.11, 2.07, 2.34,
    3.58, 3.01, 2.48, 2.14, 1.54, 1.33, 1.46, 1.94, 2, 1.2, 1.35, 4.1, 5.58, 2.51, .57, .27, .23, .21, .24, .24, .2,
    .24, .32, .26, .16, .12, .09,
};
// clang-format on

template <std::size_t kSize>
TabulatedSpectrum table(const std::array<double, kSize>& values, int min_nm, int step_nm, double unit) {
  std::vector<Float> lambda_nm, relative;
  for (std::size_t i = 0; i < kSize; ++i) {
    lambda_nm.push_back(static_cast<Float>(min_nm + step_nm * static_cast<int>(i)));
    relative.push_back(static_cast<Float>(values[i] / unit));
  }
  return {std::move(lambda_nm), std::move(relative)};
}

Spectrum fluorescent(const std::array<double, kFluorescentSamples>& values) {
  const Spectrum lamp = table(values, kFluorescentMinNm, kFluorescentStepNm, 1);
  return lamp.scaled(static_cast<Float>(1 / spectrum_to_xyz(lamp)[1]));
}

Spectrum illuminant_a_spectrum() {
  // CIE 15:2004, eq. 3.1 is Planck's law at 2848 K with c2 = 1.435e-2 m·K; with today's c2 this is the
  // temperature.
  BlackbodySpectrum a{static_cast<Float>(2848 * 1.438776877503934 / 1.435), 1};
  a.scale = 1 / a.at(560);
  return a;
}

/// The CIE rounds the weights of the components to three decimals.
double rounded(double weight) { return std::round(weight * 1000) / 1000; }

}  // namespace

TabulatedSpectrum daylight(double nominal_kelvin) {
  SPECTRACE_CHECK(nominal_kelvin >= 4000 && nominal_kelvin <= 25000);
  // The names are of the time when c2 was 1.4380e-2 m·K.
  const double t = 1e3 / (nominal_kelvin * (1.4388 / 1.4380));
  // CIE 15:2004, eqs. 3.2 to 3.6.
  const double x = t * 1e-3 >= 1.0 / 7000 ? ((-4.6070 * t + 2.9678) * t + 0.09911) * t + 0.244063
                                          : ((-2.0064 * t + 1.9018) * t + 0.24748) * t + 0.237040;
  const double y = (-3.000 * x + 2.870) * x - 0.275;
  const double m = 0.0241 + 0.2562 * x - 0.7341 * y;
  const double m1 = rounded((-1.3515 - 1.7703 * x + 5.9114 * y) / m);
  const double m2 = rounded((0.0300 - 31.4424 * x + 30.0717 * y) / m);
  std::array<double, kDaylightSamples> sum{};
  for (std::size_t i = 0; i < kDaylightSamples; ++i) {
    sum[i] = kDaylight0[i] + m1 * kDaylight1[i] + m2 * kDaylight2[i];
  }
  return table(sum, kDaylightMinNm, kDaylightStepNm, 100);
}

Spectrum named_illuminant(std::string_view name) {
  if (name == "D65") return table(kD65, kD65MinNm, kD65StepNm, 100);
  if (name == "D50") return daylight(5000);
  if (name == "D55") return daylight(5500);
  if (name == "D75") return daylight(7500);
  if (name == "A") return illuminant_a_spectrum();
  if (name == "E") return Spectrum::constant(1);
  if (name == "F2") return fluorescent(kF2);
  if (name == "F7") return fluorescent(kF7);
  SPECTRACE_CHECK(name == "F11");
  return fluorescent(kF11);
}

}  // namespace spectrace
