// SPDX-License-Identifier: Apache-2.0
#include "separation/compact.h"

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/base/error.h"
#include "separation/cell_table.h"

namespace spectrace {
namespace {

using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Rows of s_F, then of s_D, and the light each colours: Σ over phi_d of rho_s times the solid angle of a
/// node.
struct SpectralRows {
  RowMatrix value;
  Eigen::VectorXd weight;
};

SpectralRows spectral_rows(const SeparatedTables& tables) {
  const HalfDifferenceGrid& grid = tables.grid;
  const auto n = Eigen::Index(tables.axis.size()), d = Eigen::Index(grid.n_theta_d);
  SpectralRows rows{.value = RowMatrix(d + Eigen::Index(grid.angular_size()), n),
                    .weight = Eigen::VectorXd::Zero(d + Eigen::Index(grid.angular_size()))};
  const auto copy = [&](const std::vector<float>& from, Eigen::Index first) {
    for (Eigen::Index i = 0; i < Eigen::Index(from.size()); ++i) {
      rows.value(first + i / n, i % n) = double(from[std::size_t(i)]);
    }
  };
  copy(tables.s_fresnel, 0);
  copy(tables.s_diffraction, d);
  for (std::size_t group = 0; group < grid.angular_size(); ++group) {
    const auto at_d = Eigen::Index(group % std::size_t(grid.n_theta_d));
    double sum = 0;
    for (int p = 0; p < grid.n_phi_d; ++p) sum += double(tables.rho_s[group * std::size_t(grid.n_phi_d) + p]);
    const double light =
        sum * node_measure(grid, group / std::size_t(grid.n_theta_d), group % std::size_t(grid.n_theta_d));
    rows.weight[d + Eigen::Index(group)] = light;
    rows.weight[at_d] += light;
  }
  return rows;
}

/// Principal directions of the weighted rows: as few as keep the error under `tolerance`.
RowMatrix principal_basis(const SpectralRows& rows, double tolerance, CompactReport& report) {
  const RowMatrix weighted = rows.weight.cwiseSqrt().asDiagonal() * rows.value;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(weighted.transpose() * weighted);
  const Eigen::VectorXd energy = eigen.eigenvalues().cwiseMax(0.0);  // ascending
  const double total = energy.sum();
  const Eigen::Index n = energy.size();
  Eigen::Index rank = 1;
  const auto error = [&](Eigen::Index r) {
    return total > 0 ? std::sqrt(energy.head(n - r).sum() / total) : 0.0;
  };
  while (rank < std::min(n, Eigen::Index(kMaxSpectralRank)) && error(rank) > tolerance) ++rank;
  report.spectral_rank = std::size_t(rank);
  report.spectral_rms_error = error(rank);
  return eigen.eigenvectors().rightCols(rank).rowwise().reverse().transpose();
}

std::vector<float> to_floats(const RowMatrix& m) {
  std::vector<float> out(std::size_t(m.size()));
  std::transform(m.data(), m.data() + m.size(), out.begin(), [](double x) { return static_cast<float>(x); });
  return out;
}

}  // namespace

CompactResult compact(const SeparatedTables& tables, int quality, SeparationModel richest) {
  SPECTRACE_CHECK(quality >= kMinQuality && quality <= kMaxQuality);
  CompactResult result;
  CompactTables& out = result.tables;
  out.grid = tables.grid;
  out.axis = tables.axis;
  out.c_d = tables.c_d;
  out.s_sun = tables.s_sun;
  out.analytic = tables.analytic;
  if (richest == SeparationModel::kResidual) out.residual = tables.residual;
  out.source_name = tables.source_name;
  out.source_sha256 = tables.source_sha256;
  out.report_json = tables.report_json;
  std::transform(tables.diffuse_shape.begin(), tables.diffuse_shape.end(),
                 std::back_inserter(out.diffuse_shape),
                 [](float x) { return static_cast<std::uint8_t>(std::lround(x * 255)); });

  out.octaves_per_code = static_cast<float>(std::exp2(-quality));
  out.rho_s = LogCodes::encode(tables.rho_s, out.octaves_per_code);
  result.report.rho_s_error_bound = std::exp2(double(out.octaves_per_code) / 2) - 1;

  if (richest == SeparationModel::kSun) return result;
  const SpectralRows rows = spectral_rows(tables);
  const RowMatrix basis = principal_basis(rows, std::exp2(-(quality + 1)), result.report);
  const RowMatrix weights = rows.value * basis.transpose();
  out.rank = std::size_t(basis.rows());
  out.basis = to_floats(basis);
  out.s_fresnel = to_floats(weights.topRows(tables.grid.n_theta_d));
  if (richest == SeparationModel::kFresnel) return result;
  out.s_diffraction = to_floats(weights.bottomRows(Eigen::Index(tables.grid.angular_size())));
  return result;
}

}  // namespace spectrace
