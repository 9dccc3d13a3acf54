// SPDX-License-Identifier: Apache-2.0
#include "materials/measured_albedo.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/math/math.h"

namespace spectrace {
namespace {

/// Points a side of the square that directions are drawn from: as many as the database's tables have, so that
/// no cell is missed.
constexpr int kSide = 32;
/// Of values stored as float: a limited albedo may lie so far above 1.
constexpr double kRounding = 1e-6;

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

/// An incident direction that was measured.
struct Slice {
  std::size_t phi_index = 0, theta_index = 0;
  float theta_i = 0;
};

/// Visits every one with its albedo, a value for each place of the spectral axis.
template <typename Visit>
void for_each_slice(const MeasuredBrdf& measured, const Visit& visit) {
  const MeasuredTables& tables = measured.tables();
  // Only directions and densities are asked of the samples: any wavelengths do.
  std::array<Float, kLanes> lambda_nm{}, pdf_per_nm{};
  lambda_nm.fill(550);
  pdf_per_nm.fill(1);
  const SampledWavelengths lambda(lambda_nm, pdf_per_nm);
  for (std::size_t j = 0; j < tables.phi_i.size(); ++j) {
    for (std::size_t i = 0; i < tables.theta_i.size(); ++i) {
      const float phi = tables.phi_i[j], theta = tables.theta_i[i];
      if (theta > measured.last_measured_theta_i()) break;
      const Vec3 wo{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
      visit(Slice{j, i, theta}, albedo_at(measured, wo, {.lambda = lambda}));
    }
  }
}

}  // namespace

AlbedoPeak largest_albedo(const MeasuredBrdf& measured) {
  AlbedoPeak peak;
  for_each_slice(measured, [&](const Slice& slice, const std::vector<double>& albedo) {
    for (std::size_t k = 0; k < albedo.size(); ++k) {
      if (albedo[k] > peak.albedo) peak = {albedo[k], radians_to_degrees(double(slice.theta_i)), k};
    }
  });
  return peak;
}

void limit_albedo(MeasuredTables& tables, AlbedoLimit limit) {
  if (limit == AlbedoLimit::kKeep) return;
  const MeasuredBrdf measured(tables);
  const std::size_t table = std::size_t(tables.table_size) * std::size_t(tables.table_size);
  const auto divide = [&](std::size_t slice, std::size_t wavelength, double by) {
    const auto begin =
        tables.spectra.begin() + std::ptrdiff_t((slice * tables.axis.size() + wavelength) * table);
    std::transform(begin, begin + std::ptrdiff_t(table), begin,
                   [by](float x) { return float(double(x) / by); });
  };
  if (limit == AlbedoLimit::kScale) {
    const double peak = largest_albedo(measured).albedo;
    for (float& x : tables.spectra) x = float(double(x) / std::max(peak, 1.0));
    return;
  }
  const std::size_t elevations = tables.theta_i.size();
  for_each_slice(measured, [&](const Slice& slice, const std::vector<double>& albedo) {
    const bool is_last = slice.theta_index + 1 == elevations ||
                         tables.theta_i[slice.theta_index + 1] > measured.last_measured_theta_i();
    const std::size_t end = is_last ? elevations : slice.theta_index + 1;  // beyond are copies of the last
    for (std::size_t theta = slice.theta_index; theta < end; ++theta) {
      for (std::size_t k = 0; k < albedo.size(); ++k) {
        if (albedo[k] > 1) divide(slice.phi_index * elevations + theta, k, albedo[k]);
      }
    }
  });
}

std::optional<std::string> albedo_warning(const AlbedoPeak& peak, const SpectralAxis& axis) {
  if (!(peak.albedo > 1 + kRounding)) return std::nullopt;
  const std::string where = axis.is_rgb() ? std::string(1, "RGB"[peak.index])
                                          : fmt::format("{:.0f} nm", double(axis.lambda_nm()[peak.index]));
  return fmt::format(
      "albedo {:.4g} at {:.1f} degrees, {}: the measurement reflects more light than it receives",
      peak.albedo, peak.theta_deg, where);
}

}  // namespace spectrace
