// SPDX-License-Identifier: Apache-2.0
#include "separation/residual_fit.h"

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/math/math.h"
#include "materials/half_difference.h"
#include "separation/cell_table.h"
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

/// What an odd ratio is multiplied with, over M: 0 at the horizon, 1/2 at equal cosines.
double odd_factor(const DirectionPair& directions) {
  const double cos_o = std::max(double(directions.wo.z), 0.0), cos_i = std::max(double(directions.wi.z), 0.0);
  return cos_o > 0 && cos_i > 0 ? 2 * cos_o * cos_i / sqr(cos_o + cos_i) : 0;
}

/// [cell]
std::vector<double> odd_factors(const HalfDifferenceGrid& grid) {
  std::vector<double> factors;
  factors.reserve(grid.size());
  for (int h = 0; h < grid.n_theta_h; ++h) {
    for (int d = 0; d < grid.n_theta_d; ++d) {
      for (int p = 0; p < grid.n_phi_d; ++p) {
        factors.push_back(
            odd_factor(from_half_difference({grid.theta_h(h), grid.theta_d(d), grid.phi_d(p)})));
      }
    }
  }
  return factors;
}

/// Node by node: what the measurement says less what the diffraction model says, over the model's mean.
class Residuals {
 public:
  Residuals(const MeasuredBrdf& measured, const SeparatedTables& tables)
      : measured_(measured),
        tables_(tables),
        n_(tables.axis.size()),
        mean_albedo_(std::accumulate(tables.c_d.begin(), tables.c_d.end(), 0.0) / double(n_)) {}

  /// The ratios at a node, and M; 0, and nothing written, where the node has no value or the model is black.
  /// `odd`: of what changes its sign with the exchange of the directions, over 2 M cosθi cosθo /
  /// (cosθi + cosθo)², which goes with it to 0 at the horizon.
  struct Node {
    double mean = 0;
    double odd_factor = 0;  ///< what `odd` was divided by, over M; 0 where there is no such part
  };
  Node at(int h, int d, int p, Eigen::VectorXd& even, Eigen::VectorXd& odd) const {
    const HalfDifferenceGrid& grid = tables_.grid;
    const DirectionPair directions = from_half_difference({grid.theta_h(h), grid.theta_d(d), grid.phi_d(p)});
    if (!(directions.wo.z > 0 && directions.wi.z > 0)) return {};
    const ReciprocalPair pair = locate_pair(measured_, directions);
    if (!pair.any) return {};
    const std::size_t cell = grid.index(h, d, p), group = cell / std::size_t(grid.n_phi_d);
    const double shape = tables_.diffuse_shape.empty() ? 1.0 : double(tables_.diffuse_shape[cell]);
    const double cosines = double(directions.wo.z) + double(directions.wi.z);
    const double diffuse = shape * cosines / kPi64;
    const double specular = double(tables_.rho_s[cell]);
    Node node{.mean = mean_albedo_ * diffuse + specular};
    if (!(node.mean > 0)) return {};

    gather(pair, {pair.scale[0] / node.mean, pair.scale[1] / node.mean}, even);
    const float* const s_d = &tables_.s_diffraction[group * n_];
    for (std::size_t k = 0; k < n_; ++k) {
      even[Eigen::Index(k)] -= (double(tables_.c_d[k]) * diffuse + specular * double(s_d[k])) / node.mean;
    }
    odd.setZero();
    if (pair.both) {
      node.odd_factor = odd_factor(directions);
      const std::array<double, 2> scale = pair.odd_scale(directions);
      gather(pair, {scale[0] / (node.odd_factor * node.mean), scale[1] / (node.odd_factor * node.mean)}, odd);
    }
    return node;
  }

  [[nodiscard]] std::size_t axis_size() const { return n_; }
  [[nodiscard]] const HalfDifferenceGrid& grid() const { return tables_.grid; }

 private:
  void gather(const ReciprocalPair& pair, std::array<double, 2> scale, Eigen::VectorXd& row) const {
    row.setZero();
    for (std::size_t order = 0; order < 2; ++order) {
      const MeasuredBrdf::Footprint& footprint = pair.footprint[order];
      for (int i = 0; i < footprint.count; ++i) {
        const double weight = scale[order] * double(footprint.weight[i]);
        const float* const spectrum = measured_.spectrum(footprint.row[i]);
        for (std::size_t k = 0; k < n_; ++k) row[Eigen::Index(k)] += weight * double(spectrum[k]);
      }
    }
  }

  const MeasuredBrdf& measured_;
  const SeparatedTables& tables_;
  std::size_t n_;
  double mean_albedo_;
};

/// Second moments of the residual, weighted by its share of a picture's squared error.
Eigen::MatrixXd second_moments(const Residuals& residuals, bool with_odd) {
  const HalfDifferenceGrid& grid = residuals.grid();
  const auto n = Eigen::Index(residuals.axis_size());
  std::vector<Eigen::MatrixXd> slices(std::size_t(grid.n_theta_h), Eigen::MatrixXd::Zero(n, n));
  parallel_chunks(slices.size(), [&](std::size_t h) {
    Eigen::VectorXd even(n), odd(n);
    for (std::size_t i = h % kScoutStride; i < std::size_t(grid.n_theta_d) * grid.n_phi_d;
         i += kScoutStride) {
      const int d = int(i / std::size_t(grid.n_phi_d)), p = int(i % std::size_t(grid.n_phi_d));
      const Residuals::Node node = residuals.at(int(h), d, p, even, odd);
      if (!(node.mean > 0)) continue;
      const double weight = node_measure(grid, h, std::size_t(d)) * node.mean * node.mean;
      slices[h].selfadjointView<Eigen::Lower>().rankUpdate(even, weight);
      if (with_odd && node.odd_factor > 0) {
        // At equal cosines a ratio of either part adds the same: there the factor is 1/2.
        const double factor = 2 * node.odd_factor;
        slices[h].selfadjointView<Eigen::Lower>().rankUpdate(odd, weight * factor * factor);
      }
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

struct Codes {
  std::vector<std::int8_t> code;  ///< [cell][plane] in steps of kStep
  double clamped_share = 0;       ///< beyond what a byte reaches, cells counted by their weight
};
Codes encoded(std::span<const std::vector<float>> planes, std::span<const double> cell_weight) {
  const std::size_t cells = planes.front().size(), n = planes.size();
  Codes codes{.code = std::vector<std::int8_t>(cells * n)};
  double clamped = 0, all = 0;
  for (std::size_t cell = 0; cell < cells; ++cell) {
    for (std::size_t k = 0; k < n; ++k) {
      const float code = std::round(planes[k][cell] / kStep);
      clamped += std::abs(code) > 127 ? cell_weight[cell] : 0;
      codes.code[cell * n + k] = static_cast<std::int8_t>(std::clamp(code, -127.0F, 127.0F));
    }
    all += cell_weight[cell] * double(n);
  }
  codes.clamped_share = all > 0 ? clamped / all : 0;
  return codes;
}

}  // namespace

ResidualTable fit_residual(const MeasuredBrdf& measured, const SeparatedTables& tables,
                           const SeparationOptions& options, ResidualReport& report) {
  SPECTRACE_CHECK(options.residual_rank >= 1 && std::size_t(options.residual_rank) <= kMaxResidualRank);
  const Residuals residuals(measured, tables);
  const HalfDifferenceGrid& grid = tables.grid;
  const bool with_odd = !options.reciprocal;
  const Eigen::MatrixXd basis =
      components(second_moments(residuals, with_odd), std::size_t(options.residual_rank), report.explained);
  const auto count = std::size_t(basis.rows());
  if (count == 0) return {};

  // The terms of the even part, then of the odd one.
  std::vector<std::vector<float>> planes(with_odd ? 2 * count : count,
                                         std::vector<float>(grid.size(), kNoValue));
  const Eigen::MatrixXd project = basis / double(residuals.axis_size());
  parallel_chunks(std::size_t(grid.n_theta_h), [&](std::size_t h) {
    Eigen::VectorXd even(Eigen::Index(residuals.axis_size())), odd(even.size()), terms(basis.rows());
    const auto store = [&](const Eigen::VectorXd& row, std::size_t cell, std::size_t first_plane) {
      terms.noalias() = project * row;
      for (std::size_t k = 0; k < count; ++k) {
        planes[first_plane + k][cell] = static_cast<float>(terms[Eigen::Index(k)]);
      }
    };
    for (int d = 0; d < grid.n_theta_d; ++d) {
      for (int p = 0; p < grid.n_phi_d; ++p) {
        if (!(residuals.at(int(h), d, p, even, odd).mean > 0)) continue;
        store(even, grid.index(int(h), d, p), 0);
        if (with_odd) store(odd, grid.index(int(h), d, p), count);
      }
    }
  });
  parallel_chunks(planes.size(), [&](std::size_t k) {
    k < count ? fill_unmeasured(grid, planes[k]) : fill_unmeasured_odd(grid, planes[k]);
  });

  ResidualTable table{
      .basis = {}, .ratio = {}, .odd = {}, .step = kStep, .rank = count, .axis_size = residuals.axis_size()};
  for (Eigen::Index k = 0; k < basis.rows(); ++k) {
    for (Eigen::Index i = 0; i < basis.cols(); ++i) table.basis.push_back(static_cast<float>(basis(k, i)));
  }
  Codes even = encoded(std::span(planes).first(count), std::vector<double>(grid.size(), 1.0));
  table.ratio = std::move(even.code);
  report.clamped_share = even.clamped_share;
  if (with_odd) {
    Codes odd = encoded(std::span(planes).subspan(count), odd_factors(grid));
    table.odd = std::move(odd.code);
    report.odd_clamped_share = odd.clamped_share;
  }
  return table;
}

}  // namespace spectrace
