// SPDX-License-Identifier: Apache-2.0
#include "core/spectra/color.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/spectra/cie_tables.h"

namespace spectrace {
namespace {

constexpr double kLabToe = 216.0 / 24389.0, kLabToeSlope = 841.0 / 108.0;  // CIE 15: (6/29)³, (29/6)² / 3

using Matrix3 = std::array<std::array<double, 3>, 3>;

std::array<double, 3> multiply(const Matrix3& m, const std::array<double, 3>& v) {
  std::array<double, 3> r{};
  for (std::size_t i = 0; i < 3; ++i) r[i] = m[i][0] * v[0] + m[i][1] * v[1] + m[i][2] * v[2];
  return r;
}

Matrix3 inverse(const Matrix3& m) {
  Matrix3 r{};
  double determinant = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t i1 = (i + 1) % 3, i2 = (i + 2) % 3;
    for (std::size_t j = 0; j < 3; ++j) {
      const std::size_t j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      r[j][i] = m[i1][j1] * m[i2][j2] - m[i1][j2] * m[i2][j1];
    }
    determinant += m[0][i] * r[i][0];
  }
  for (auto& row : r) {
    for (double& x : row) x /= determinant;
  }
  return r;
}

/// ∫ weight(λ) (x̄, ȳ, z̄) dλ by trapezoids of at most 1 nm, the step of the tables.
template <typename Weight>
Xyz integrate_xyz(double min_nm, double max_nm, const Weight& weight) {
  const int steps = std::max(1, static_cast<int>(std::ceil(max_nm - min_nm)));
  const double step_nm = (max_nm - min_nm) / steps;
  Xyz sum{};
  for (int i = 0; i <= steps; ++i) {
    const double lambda_nm = min_nm + i * step_nm;
    const Xyz bar = cie_xyz_bar(lambda_nm);
    const double w = weight(lambda_nm) * (i == 0 || i == steps ? 0.5 : 1.0);
    for (std::size_t c = 0; c < 3; ++c) sum[c] += w * bar[c];
  }
  for (double& x : sum) x *= step_nm;
  return sum;
}

Xyz divided(Xyz xyz, double by) {
  for (double& x : xyz) x /= by;
  return xyz;
}

struct SrgbMatrices {
  Matrix3 to_xyz, from_xyz;
};

/// From the chromaticities of IEC 61966-2-1 and, as white, D65 as this program integrates it: rounding in the
/// standard's own white and matrix (four digits) would tint every white object by 2e-4.
SrgbMatrices make_srgb() {
  constexpr double kPrimaries[3][2] = {{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}};
  Matrix3 columns{};
  for (std::size_t c = 0; c < 3; ++c) {
    const double x = kPrimaries[c][0], y = kPrimaries[c][1];
    columns[0][c] = x / y;
    columns[1][c] = 1;
    columns[2][c] = (1 - x - y) / y;
  }
  const Xyz d65 = integrate_xyz(kCieMinNm, kCieMaxNm, illuminant_d65);
  const auto luminance = multiply(inverse(columns), divided(d65, d65[1]));
  for (auto& row : columns) {
    for (std::size_t c = 0; c < 3; ++c) row[c] *= luminance[c];
  }
  return {columns, inverse(columns)};
}
const SrgbMatrices& srgb() {
  static const SrgbMatrices matrices = make_srgb();
  return matrices;
}

}  // namespace

Xyz cie_xyz_bar(double lambda_nm) {
  if (!(lambda_nm >= kCieMinNm && lambda_nm <= kCieMaxNm)) return {};
  const double position = lambda_nm - kCieMinNm;
  const auto i = std::min(static_cast<std::size_t>(position), kCieSamples - 2);
  const double t = position - double(i);
  const auto at = [&](const std::array<double, kCieSamples>& bar) {
    return (1 - t) * bar[i] + t * bar[i + 1];
  };
  return {at(kCieXBar), at(kCieYBar), at(kCieZBar)};
}

double cie_y_integral() {
  static const double integral = integrate_xyz(kCieMinNm, kCieMaxNm, [](double) { return 1.0; })[1];
  return integral;
}

double illuminant_d65(double lambda_nm) {
  const double position = std::clamp((lambda_nm - kD65MinNm) / kD65StepNm, 0.0, double(kD65Samples - 1));
  const auto i = std::min(static_cast<std::size_t>(position), kD65Samples - 2);
  const double t = position - double(i);
  return ((1 - t) * kD65[i] + t * kD65[i + 1]) / 100;
}

double illuminant_a(double lambda_nm) {
  // CIE 15:2004, eq. 3.1: Planck at 2848 K with the c2 of its time, 1.435e7 nm·K.
  const auto planck = [](double nm) { return std::pow(nm, -5) / std::expm1(1.435e7 / (2848 * nm)); };
  return planck(lambda_nm) / planck(560);
}

double d65_luminance() {
  static const double luminance = integrate_xyz(kCieMinNm, kCieMaxNm, illuminant_d65)[1] / cie_y_integral();
  return luminance;
}

Xyz spectrum_to_xyz(const Spectrum& emission, WavelengthRange range) {
  const auto radiance = [&](double nm) { return double(emission.at(static_cast<Float>(nm))); };
  return divided(integrate_xyz(range.min_nm, range.max_nm, radiance), cie_y_integral());
}

Xyz reflectance_to_xyz(const Spectrum& reflectance, double (*illuminant)(double)) {
  const auto reflected = [&](double nm) {
    return double(reflectance.at(static_cast<Float>(nm))) * illuminant(nm);
  };
  return divided(integrate_xyz(kCieMinNm, kCieMaxNm, reflected),
                 integrate_xyz(kCieMinNm, kCieMaxNm, illuminant)[1]);
}

Rgb xyz_to_rgb(const Xyz& xyz) { return multiply(srgb().from_xyz, xyz); }
Xyz rgb_to_xyz(const Rgb& rgb) { return multiply(srgb().to_xyz, rgb); }

double lab_curve(double t) { return t > kLabToe ? std::cbrt(t) : kLabToeSlope * t + 4.0 / 29.0; }
double lab_slope(double t) { return t > kLabToe ? 1 / (3 * std::cbrt(t) * std::cbrt(t)) : kLabToeSlope; }

Xyz xyz_to_lab(const Xyz& xyz, const Xyz& white) {
  const double x = lab_curve(xyz[0] / white[0]), y = lab_curve(xyz[1] / white[1]),
               z = lab_curve(xyz[2] / white[2]);
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

double srgb_encode(double linear) {
  const double x = std::clamp(linear, 0.0, 1.0);
  return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
}
double srgb_decode(double encoded) {
  const double x = std::clamp(encoded, 0.0, 1.0);
  return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
}

}  // namespace spectrace
