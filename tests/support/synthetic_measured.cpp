// SPDX-License-Identifier: Apache-2.0
#include "tests/support/synthetic_measured.h"

#include <algorithm>
#include <cmath>

#include "core/math/math.h"

namespace spectrace::test {

namespace {

/// The centred azimuth of a node of an axis over [0, 1].
double azimuth(std::size_t k, std::size_t nodes) { return 2 * kPi64 * double(k) / double(nodes - 1) - kPi64; }

/// A ripple in [-1, 1] over the azimuths a of the incident and b of the other direction that has just the
/// symmetry asked for: a rotation by half a turn for 2, both mirrors for 4, none for 1.
double ripple(const SyntheticMeasured& options, double a, double b) {
  if (options.isotropic) return 0.5 * std::cos(b) + 0.3 * std::sin(2 * b);
  double r = 0.4 * std::cos(2 * b) + 0.2 * std::cos(2 * a - 2 * b);
  if (options.symmetry <= 2) r += 0.2 * std::sin(2 * b) + 0.1 * std::sin(2 * a);
  if (options.symmetry == 1) r += 0.1 * std::cos(a);
  return r;
}

std::vector<float> azimuths(const SyntheticMeasured& options) {
  if (options.isotropic) return {0};
  const int count = 8 / options.stored_reduction + 1;
  std::vector<float> out;
  for (int i = 0; i < count; ++i) out.push_back(static_cast<float>(options.first_phi_i + i * kPi64 / 4));
  return out;
}

void add_warp_slice(const SyntheticMeasured& options, double phi, double theta, MeasuredTables& out) {
  const auto n = static_cast<std::size_t>(out.warp_size);
  for (std::size_t y = 0; y < n; ++y) {
    for (std::size_t x = 0; x < n; ++x) {
      const double u = double(x) / double(n - 1);
      const double radial = u * u * std::max(0.0, 1.05 - u) * (1 + 0.5 * theta * u);
      out.vndf.push_back(static_cast<float>(1e-3 * radial * (1 + 0.8 * ripple(options, phi, azimuth(y, n)))));
    }
  }
}

double table_value(const SyntheticMeasured& options, double phi, double theta, double lambda, double s,
                   double b) {
  if (s > 0.95) return 0;  // as beyond the horizon
  const double colour = 1 + 0.5 * std::sin(lambda * 4 + 3 * s + theta);
  return 0.3 * colour * (1.1 - s) * (1 + 0.7 * ripple(options, phi, b)) * (1 + 0.3 * theta);
}

void add_table_slices(const SyntheticMeasured& options, double phi, double theta, MeasuredTables& out) {
  const auto m = static_cast<std::size_t>(out.table_size);
  const std::size_t channels = out.axis.size();
  std::vector<float> mean(m * m);
  for (std::size_t k = 0; k < channels; ++k) {
    for (std::size_t i = 0; i < m * m; ++i) {
      const double s = double(i % m) / double(m - 1), lambda = double(k) / double(channels);
      out.spectra.push_back(
          static_cast<float>(table_value(options, phi, theta, lambda, s, azimuth(i / m, m))));
      mean[i] += out.spectra.back() / static_cast<float>(channels);
    }
  }
  out.luminance.insert(out.luminance.end(), mean.begin(), mean.end());
  for (const float x : mean) out.valid.push_back(x > 0 ? 1 : 0);
}

}  // namespace

MeasuredTables make_measured(const SyntheticMeasured& options) {
  MeasuredTables out;
  out.file_name = "synthetic.bsdf";
  out.description = "made by a test";
  out.phi_i = azimuths(options);
  out.theta_i = {0, 0.5f, 0.9f, 1.3f, 1.5707963f};
  out.ndf_width = 33;
  out.ndf_height = options.isotropic ? 2 : 17;
  out.warp_size = 17;
  out.table_size = 9;
  out.axis =
      options.rgb ? SpectralAxis::rgb() : SpectralAxis::wavelengths({400, 450, 500, 550, 600, 650, 700});
  out.jacobian = options.jacobian;

  const auto h = static_cast<std::size_t>(out.ndf_height), w = static_cast<std::size_t>(out.ndf_width);
  for (std::size_t y = 0; y < h; ++y) {
    // The two rows of an isotropic table are equal: -π and π.
    const double wave = options.isotropic ? 0 : ripple(options, 0, azimuth(y, h)) - ripple(options, 0, 0) / 2;
    for (std::size_t x = 0; x < w; ++x) {
      const double u = double(x) / double(w - 1);
      out.ndf.push_back(static_cast<float>(std::max(0.0, std::exp(-4 * u * u) * (1 + 0.2 * wave) - 0.02)));
      out.sigma.push_back(static_cast<float>((1 - 0.98 * u * u) * (1 + 0.1 * wave)));
    }
  }
  for (const float phi : out.phi_i) {
    for (std::size_t t = 0; t < out.theta_i.size(); ++t) {
      const double theta = out.theta_i[std::min(t, out.theta_i.size() - 2)];
      add_warp_slice(options, phi, theta, out);
      add_table_slices(options, phi, theta, out);
    }
  }
  return out;
}

}  // namespace spectrace::test
