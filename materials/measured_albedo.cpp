// SPDX-License-Identifier: Apache-2.0
#include "materials/measured_albedo.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <vector>

#include "core/math/math.h"

namespace spectrace {
namespace {

/// Points a side of the square that directions are drawn from: as many as the database's tables have, so that
/// no cell is missed.
constexpr int kSide = 32;

/// Sums over the axis of value / density, at the middles of the square's cells.
void add_direction(const MeasuredBrdf& measured, Vec3 wo, Vec3 wi, double pdf, std::vector<double>& sum) {
  const std::optional<MeasuredBrdf::Footprint> at = measured.footprint(wo, wi);
  for (int i = 0; at && i < at->count; ++i) {
    const float* const row = measured.spectrum(at->row[i]);
    const double weight = double(at->weight[i]) / pdf;
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += weight * double(row[k]);
  }
}

std::vector<double> albedo_at(const MeasuredBrdf& measured, Vec3 wo, const ShadingPoint& at) {
  std::vector<double> sum(measured.axis().size());
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const Vec2 u{(Float(x) + Float(0.5)) / kSide, (Float(y) + Float(0.5)) / kSide};
      if (const auto s = measured.sample(wo, {Float(0.5), u}, at)) {
        add_direction(measured, wo, s->wi, double(s->pdf), sum);
      }
    }
  }
  for (double& x : sum) x /= double(kSide) * kSide;
  return sum;
}

}  // namespace

AlbedoPeak largest_albedo(const MeasuredBrdf& measured) {
  const MeasuredTables& tables = measured.tables();
  // Only directions and densities are asked of the samples: any wavelengths do.
  std::array<Float, kLanes> lambda_nm{}, pdf_per_nm{};
  lambda_nm.fill(550);
  pdf_per_nm.fill(1);
  const SampledWavelengths lambda(lambda_nm, pdf_per_nm);
  AlbedoPeak peak;
  for (const float phi : tables.phi_i) {
    for (const float theta : tables.theta_i) {
      if (theta > measured.last_measured_theta_i()) break;
      const Vec3 wo{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
      const std::vector<double> albedo = albedo_at(measured, wo, {.lambda = lambda});
      for (std::size_t k = 0; k < albedo.size(); ++k) {
        if (albedo[k] > peak.albedo) peak = {albedo[k], radians_to_degrees(double(theta)), k};
      }
    }
  }
  return peak;
}

std::optional<std::string> albedo_warning(const AlbedoPeak& peak, const SpectralAxis& axis) {
  if (!(peak.albedo > 1)) return std::nullopt;
  const std::string where = axis.is_rgb() ? std::string(1, "RGB"[peak.index])
                                          : fmt::format("{:.0f} nm", double(axis.lambda_nm()[peak.index]));
  return fmt::format(
      "albedo {:.4g} at {:.1f} degrees, {}: the measurement reflects more light than it receives",
      peak.albedo, peak.theta_deg, where);
}

}  // namespace spectrace
