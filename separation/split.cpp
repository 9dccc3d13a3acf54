// SPDX-License-Identifier: Apache-2.0
#include "separation/split.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "core/math/math.h"
#include "separation/analytic_fit.h"
#include "separation/fill_grid.h"

namespace spectrace {
namespace {

// Hard case H9: a lobe that holds no more of the reflected light than interpolation noise and the misfit of
// eq. 12 leave behind becomes exactly 0. Without a diffuse lobe the specular table takes all of the mean, so
// nothing is lost; without a specular one its light is, hence the smaller share. (Measured on acquired
// materials of one lobe: 0.8 % of stray diffuse light in a rough metal, 0.02 % of stray specular light in a
// matte colour.)
constexpr double kEmptyDiffuse = 1e-2, kEmptySpecular = 1e-3;

// Weights of eq. 16, the paper's. Only their order matters to the optimum; with this one it is the Lambert
// lobe, clamped to the mean, as the renderer's exactly Lambertian lobe needs it.
constexpr double kEtaDiffuse = 0.9, kEtaSpecular = 0.8;

struct Energies {
  double total = 0, specular = 0, missing = 0;
};

/// Reflected light, for uniform light and averaged over all views: ∫∫ f (cosθi + cosθo)/2 dωi dωo over the
/// measured cells, with dωi dωo = 4 cosθd dωh dωd.
Energies energies(const CellTable& table, double lambert) {
  const HalfDifferenceGrid& grid = table.grid;
  Energies e;
  for (std::size_t group = 0; group < grid.angular_size(); ++group) {
    const auto n_d = std::size_t(grid.n_theta_d);
    const double measure = node_measure(grid, group / n_d, group % n_d);
    for (std::size_t i = table.begin[group]; i < table.begin[group + 1]; ++i) {
      const double w = measure * table.cos_sum(i), mean = double(table.mean[i]);
      e.total += w * mean;
      e.specular += w * std::max(mean - lambert, 0.0);
      e.missing += w * std::max(lambert - mean, 0.0);
    }
  }
  return e;
}

double optimum_cost(const CellTable& table, const AnalyticFit& fit) {
  double cost = 0;
  const double lambert = fit.albedo_d / kPi64;
  for (int h = 0; h < table.grid.n_theta_h; ++h) {
    const double cos_h = std::cos(table.grid.theta_h(h));
    for (int d = 0; d < table.grid.n_theta_d; ++d) {
      const double cos_d = std::cos(table.grid.theta_d(d));
      const std::size_t group = std::size_t(h) * table.grid.n_theta_d + d;
      for (std::size_t i = table.begin[group]; i < table.begin[group + 1]; ++i) {
        const double mean = double(table.mean[i]);
        const double ggx =
            analytic_specular(fit, cos_h, cos_d, double(table.cos_i[i]), double(table.cos_o[i]));
        const double x = split_cell(mean, lambert, ggx, kEtaDiffuse, kEtaSpecular);
        cost += double(table.weight[i]) *
                (kEtaDiffuse * std::abs(x - lambert) + kEtaSpecular * std::abs(mean - x - ggx));
      }
    }
  }
  return cost;
}

/// min(mean, Lambert) / Lambert: ρ_d of eq. 16.
std::vector<float> diffuse_table(const CellTable& table, double lambert) {
  const HalfDifferenceGrid& grid = table.grid;
  std::vector<float> shape(grid.size());
  for (std::size_t cell = 0; cell < grid.size(); ++cell) {
    const std::size_t group = cell / grid.n_phi_d;
    const double lambert_q = lambert * 2 * std::cos(grid.theta_h(double(group / grid.n_theta_d))) *
                             std::cos(grid.theta_d(double(group % grid.n_theta_d)));
    const float mean = table.mean_q[cell];
    shape[cell] = mean < 0 ? kNoValue : static_cast<float>(std::min(double(mean) / lambert_q, 1.0));
  }
  fill_unmeasured(grid, shape);
  return shape;
}

/// mean_q less the Lambert lobe, clamped: the specular table as the renderer needs it.
std::vector<float> specular_table(const CellTable& table, double lambert) {
  const HalfDifferenceGrid& grid = table.grid;
  std::vector<float> rho_s(grid.size());
  for (int h = 0; h < grid.n_theta_h; ++h) {
    for (int d = 0; d < grid.n_theta_d; ++d) {
      // cosθi + cosθo = 2 cosθh cosθd, whatever phi_d
      const double lambert_q = lambert * 2 * std::cos(grid.theta_h(h)) * std::cos(grid.theta_d(d));
      for (int p = 0; p < grid.n_phi_d; ++p) {
        const std::size_t cell = grid.index(h, d, p);
        const float mean = table.mean_q[cell];
        rho_s[cell] = mean < 0 ? kNoValue : static_cast<float>(std::max(double(mean) - lambert_q, 0.0));
      }
    }
  }
  fill_unmeasured(grid, rho_s);
  return rho_s;
}

}  // namespace

double split_cell(double mean, double diffuse, double specular, double eta_diffuse, double eta_specular) {
  const double optimum = eta_diffuse >= eta_specular ? diffuse : mean - specular;
  return std::clamp(optimum, 0.0, mean);
}

double lambert_excess(const CellTable& table, double albedo) {
  const Energies e = energies(table, albedo / kPi64);
  return e.total > 0 ? e.missing / e.total : 0;
}

SplitResult split_lobes(const CellTable& table, const AnalyticFit& fit, bool matte,
                        const SeparationOptions& options) {
  SplitResult result;
  result.cost = optimum_cost(table, fit);
  result.albedo_d = fit.albedo_d;
  Energies e = energies(table, result.albedo_d / kPi64);
  if (!matte && e.total > 0 && (e.total - e.specular) < kEmptyDiffuse * e.total) {
    result.albedo_d = 0;
    e = energies(table, 0);
  }
  if (matte || e.total <= 0 || e.specular < kEmptySpecular * e.total) {
    result.rho_s.assign(table.grid.size(), 0.0F);
    return result;
  }
  result.rho_s = specular_table(table, result.albedo_d / kPi64);
  if (options.diffuse == DiffuseForm::kTable && e.missing > 0) {
    result.diffuse_shape = diffuse_table(table, result.albedo_d / kPi64);
  }
  result.specular_share = e.specular / e.total;
  result.lambert_cost = e.missing / e.total;
  return result;
}

}  // namespace spectrace
