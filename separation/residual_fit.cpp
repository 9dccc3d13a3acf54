// SPDX-License-Identifier: Apache-2.0
#include "separation/residual_fit.h"

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/math/math.h"
#include "materials/half_difference.h"
#include "separation/fill_grid.h"
#include "separation/parallel.h"
#include "separation/reciprocal_pair.h"

namespace spectrace {
namespace {

// One byte at this step reaches 2.6 times the mean: all but the most saturated nodes; its rounding, 0.6 % of
// a node's brightness, averages out over the nodes that a pixel sees.
constexpr float kStep = 1.0F / 48;
// The components are found on one node in seven (7 divides no dimension of the paper's grid).
constexpr int kScoutStride = 7;
// Components below this share of the residual are noise of the arithmetic.
constexpr double kNegligible = 1e-6;

/// Node by node: what the measurement says less what the diffraction model says, over the model's mean.
class Residuals {
 public:
  Residuals(const MeasuredBrdf& measured, const SeparatedTables& tables)
      : measured_(measured),
        tables_(tables),
        n_(tables.axis.size()),
        mean_albedo_(std::accumulate(tables.c_d.begin(), tables.c_d.end(), 0.0) / double(n_)) {}

  /// M; 0 where the node has no value or the model is black there (`row` is not written then). Else `row`
  /// gets the ratios.
  double at(int h, int d, int p, Eigen::VectorXd& row) const {
    const HalfDifferenceGrid& grid = tables_.grid;
    const DirectionPair directions = from_half_difference({grid.theta_h(h), grid.theta_d(d), grid.phi_d(p)});
    if (!(directions.wo.z > 0 && directions.wi.z > 0)) return 0;
    const ReciprocalPair pair = locate_pair(measured_, directions);
    if (!pair.any) return 0;
    const std::size_t cell = grid.index(h, d, p), group = cell / std::size_t(grid.n_phi_d);
    const double shape = tables_.diffuse_shape.empty() ? 1.0 : double(tables_.diffuse_shape[cell]);
    const double diffuse = shape * double(directions.wo.z + directions.wi.z) / kPi64;
    const double specular = double(tables_.rho_s[cell]);
    const double mean = mean_albedo_ * diffuse + specular;
    if (!(mean > 0)) return 0;

    row.setZero();
    for (std::size_t order = 0; order < 2; ++order) {
      const MeasuredBrdf::Footprint& footprint = pair.footprint[order];
      for (int i = 0; i < footprint.count; ++i) {
        const double weight = pair.scale[order] * double(footprint.weight[i]) / mean;
        const float* const spectrum = measured_.spectrum(footprint.row[i]);
        for (std::size_t k = 0; k < n_; ++k) row[Eigen::Index(k)] += weight * double(spectrum[k]);
      }
    }
    const float* const s_d = &tables_.s_diffraction[group * n_];
    for (std::size_t k = 0; k < n_; ++k) {
      row[Eigen::Index(k)] -= (double(tables_.c_d[k]) * diffuse + specular * double(s_d[k])) / mean;
    }
    return mean;
  }

  [[nodiscard]] std::size_t axis_size() const { return n_; }
  [[nodiscard]] const HalfDifferenceGrid& grid() const { return tables_.grid; }

 private:
  const MeasuredBrdf& measured_;
  const SeparatedTables& tables_;
  std::size_t n_;
  double mean_albedo_;
};

/// Second moments of the residual, weighted by its share of a picture's squared error.
Eigen::MatrixXd second_moments(const Residuals& residuals) {
  const HalfDifferenceGrid& grid = residuals.grid();
  const auto n = Eigen::Index(residuals.axis_size());
  std::vector<Eigen::MatrixXd> slices(std::size_t(grid.n_theta_h), Eigen::MatrixXd::Zero(n, n));
  parallel_chunks(slices.size(), [&](std::size_t h) {
    const double step_h = grid.theta_h(double(h) + 0.5) - grid.theta_h(std::max(double(h) - 0.5, 0.0));
    Eigen::VectorXd row(n);
    for (std::size_t i = h % kScoutStride; i < std::size_t(grid.n_theta_d) * grid.n_phi_d;
         i += kScoutStride) {
      const int d = int(i / std::size_t(grid.n_phi_d)), p = int(i % std::size_t(grid.n_phi_d));
      const double mean = residuals.at(int(h), d, p, row);
      if (!(mean > 0)) continue;
      const double solid_angle =
          std::sin(grid.theta_h(double(h))) * step_h * std::sin(grid.theta_d(d)) * std::cos(grid.theta_d(d));
      slices[h].selfadjointView<Eigen::Lower>().rankUpdate(row, solid_angle * mean * mean);
    }
  });
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(n, n);
  for (const Eigen::MatrixXd& slice : slices) sum += slice;
  return sum;
}

/// Rows are components, scaled to a mean square of 1 over the axis.
Eigen::MatrixXd components(const Eigen::MatrixXd& moments, std::size_t rank, double& explained) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(moments);  // reads the lower triangle
  const Eigen::VectorXd energy = eigen.eigenvalues().cwiseMax(0.0);     // ascending
  const Eigen::Index n = energy.size();
  const double total = energy.sum();
  Eigen::Index count = 0;
  while (count < std::min(Eigen::Index(rank), n) && energy[n - 1 - count] > kNegligible * total) ++count;
  explained = total > 0 ? energy.tail(count).sum() / total : 1;
  return eigen.eigenvectors().rightCols(count).rowwise().reverse().transpose() * std::sqrt(double(n));
}

}  // namespace

ResidualTable fit_residual(const MeasuredBrdf& measured, const SeparatedTables& tables, std::size_t rank,
                           ResidualReport& report) {
  SPECTRACE_CHECK(rank >= 1 && rank <= kMaxResidualRank);
  const Residuals residuals(measured, tables);
  const HalfDifferenceGrid& grid = tables.grid;
  const Eigen::MatrixXd basis = components(second_moments(residuals), rank, report.explained);
  const auto count = std::size_t(basis.rows());
  if (count == 0) return {};

  std::vector<std::vector<float>> planes(count, std::vector<float>(grid.size(), kNoValue));
  const Eigen::MatrixXd project = basis / double(residuals.axis_size());
  parallel_chunks(std::size_t(grid.n_theta_h), [&](std::size_t h) {
    Eigen::VectorXd row(Eigen::Index(residuals.axis_size())), terms(basis.rows());
    for (int d = 0; d < grid.n_theta_d; ++d) {
      for (int p = 0; p < grid.n_phi_d; ++p) {
        if (!(residuals.at(int(h), d, p, row) > 0)) continue;
        terms.noalias() = project * row;
        for (std::size_t k = 0; k < count; ++k) {
          planes[k][grid.index(int(h), d, p)] = static_cast<float>(terms[Eigen::Index(k)]);
        }
      }
    }
  });
  parallel_chunks(count, [&](std::size_t k) { fill_unmeasured(grid, planes[k]); });

  ResidualTable table{
      .basis = {}, .ratio = {}, .step = kStep, .rank = count, .axis_size = residuals.axis_size()};
  for (Eigen::Index k = 0; k < basis.rows(); ++k) {
    for (Eigen::Index i = 0; i < basis.cols(); ++i) table.basis.push_back(static_cast<float>(basis(k, i)));
  }
  table.ratio.resize(grid.size() * count);
  std::size_t clamped = 0;
  for (std::size_t cell = 0; cell < grid.size(); ++cell) {
    for (std::size_t k = 0; k < count; ++k) {
      const float code = std::round(planes[k][cell] / kStep);
      clamped += std::abs(code) > 127 ? 1 : 0;
      table.ratio[cell * count + k] = static_cast<std::int8_t>(std::clamp(code, -127.0F, 127.0F));
    }
  }
  report.clamped_share = double(clamped) / double(table.ratio.size());
  return table;
}

}  // namespace spectrace
