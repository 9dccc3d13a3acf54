// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/separation/ceres_fits.h"

#include <ceres/ceres.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>

#include "core/math/math.h"

namespace spectrace::test {
namespace {

constexpr double kLeastAlpha = 1e-3;

/// One cell of eq. 7.
struct Cell {
  double sin2_h, schlick, cos_i, cos_o, weight, log_data;
  std::size_t theta_d;
};

std::vector<Cell> cells_of(const CellTable& table, double epsilon, std::size_t stride, double least_cosine) {
  std::vector<Cell> cells;
  const auto n_d = std::size_t(table.grid.n_theta_d);
  for (std::size_t group = 0; group < table.grid.angular_size(); ++group) {
    const double sin_h = std::sin(table.grid.theta_h(double(group / n_d)));
    const double cos_d = std::cos(table.grid.theta_d(double(group % n_d)));
    for (std::size_t i = table.begin[group]; i < table.begin[group + 1]; i += stride) {
      const double cos_i = double(table.cos_i[i]), cos_o = double(table.cos_o[i]),
                   w = double(table.weight[i]);
      if (std::min(cos_i, cos_o) < least_cosine) continue;
      cells.push_back({sin_h * sin_h, std::pow(1 - cos_d, 5), cos_i, cos_o, w,
                       std::log(double(table.mean[i]) * w + epsilon), group % n_d});
    }
  }
  return cells;
}

/// D G / (4 cosθi cosθo) of eqs. 12, 14 and 15.
template <typename T>
T ggx(const Cell& c, const T& log_alpha) {
  const T a2 = exp(log_alpha * 2.0), t = a2 * (1 - c.sin2_h) + c.sin2_h;
  const auto g = [&](double cosine) { return cosine + sqrt(a2 * (1 - cosine * cosine) + cosine * cosine); };
  return a2 / (t * t * g(c.cos_i) * g(c.cos_o) * kPi64);
}

struct Eq7 {
  const Cell& c;
  double epsilon;
  template <typename T>
  bool operator()(const T* x, T* residual) const {
    const T fresnel = x[2] + (1.0 - x[2]) * c.schlick;
    const T model = x[0] / kPi64 + x[1] * fresnel * ggx(c, x[3]);
    residual[0] = c.log_data - log(model * c.weight + epsilon);
    return true;
  }
};

struct FreeFresnel {
  const Cell& c;
  double epsilon;
  template <typename T>
  bool operator()(const T* x, const T* factor, T* residual) const {
    residual[0] = c.log_data - log((x[0] / kPi64 + factor[0] * ggx(c, x[1])) * c.weight + epsilon);
    return true;
  }
};

/// Derivatives by hand: the fastest that Ceres can be given.
class ColourCost final : public ceres::CostFunction {
 public:
  /// Without `s_d` it is an unknown too, the first.
  ColourCost(const std::vector<ColourSample>& samples, double epsilon, const double* s_d)
      : samples_(samples), epsilon_(epsilon), s_d_(s_d) {
    set_num_residuals(static_cast<int>(samples.size()));
    mutable_parameter_block_sizes()->push_back(s_d ? 1 : 2);
  }
  bool Evaluate(const double* const* x, double* residuals, double** jacobians) const override {
    const double s_d = s_d_ ? *s_d_ : x[0][0], s = s_d_ ? x[0][0] : x[0][1];
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      const ColourSample& c = samples_[i];
      const double model = s_d * c.diffuse + s * c.specular + epsilon_;
      residuals[i] = std::log((c.data + epsilon_) / model);
      if (!jacobians || !jacobians[0]) continue;
      if (s_d_) {
        jacobians[0][i] = -c.specular / model;
      } else {
        jacobians[0][2 * i] = -c.diffuse / model;
        jacobians[0][2 * i + 1] = -c.specular / model;
      }
    }
    return true;
  }

 private:
  const std::vector<ColourSample>& samples_;
  double epsilon_;
  const double* s_d_;
};

void solve(ceres::Problem& problem, CeresFit& fit, bool check_gradients = false) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
  options.max_num_iterations = 200;
  options.function_tolerance = options.parameter_tolerance = 1e-14;
  options.gradient_tolerance = 0;
  options.num_threads = 1;
  options.logging_type = ceres::SILENT;
  options.check_gradients = check_gradients;
  ceres::Solver::Summary summary;
  const auto start = std::chrono::steady_clock::now();
  ceres::Solve(options, &problem, &summary);
  fit.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  fit.cost = summary.final_cost;
  if (!summary.IsSolutionUsable()) fit.cost = std::numeric_limits<double>::quiet_NaN();
}

/// Without a step: cost, and the gradient projected on the bounds.
void evaluate(ceres::Problem& problem, CeresFit& fit) {
  std::vector<double*> blocks;
  problem.GetParameterBlocks(&blocks);
  ceres::Problem::EvaluateOptions options;
  options.parameter_blocks = blocks;
  std::vector<double> gradient;
  problem.Evaluate(options, &fit.cost, nullptr, &gradient, nullptr);
  std::size_t i = 0;
  for (double* block : blocks) {
    for (int k = 0; k < problem.ParameterBlockSize(block); ++k, ++i) {
      const bool is_low = block[k] <= problem.GetParameterLowerBound(block, k) && gradient[i] > 0;
      const bool is_high = block[k] >= problem.GetParameterUpperBound(block, k) && gradient[i] < 0;
      if (!is_low && !is_high) fit.gradient_max = std::max(fit.gradient_max, std::abs(gradient[i]));
    }
  }
}

void bound(ceres::Problem& problem, double* block, int index, double low, double high) {
  problem.SetParameterLowerBound(block, index, low);
  if (std::isfinite(high)) problem.SetParameterUpperBound(block, index, high);
}

constexpr double kUnbounded = std::numeric_limits<double>::infinity();

void pose_eq_7(ceres::Problem& problem, const std::vector<Cell>& cells, double epsilon, CeresFit& fit) {
  for (const Cell& c : cells) {
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<Eq7, 1, 4>(new Eq7{c, epsilon}), nullptr,
                             fit.x.data());
  }
  bound(problem, fit.x.data(), 0, 0, 1);
  bound(problem, fit.x.data(), 1, 0, kUnbounded);
  bound(problem, fit.x.data(), 2, 0, 1);
  bound(problem, fit.x.data(), 3, std::log(kLeastAlpha), 0);
}

void pose_free_fresnel(ceres::Problem& problem, const std::vector<Cell>& cells, double epsilon,
                       CeresFit& fit) {
  for (const Cell& c : cells) {
    problem.AddResidualBlock(
        new ceres::AutoDiffCostFunction<FreeFresnel, 1, 2, 1>(new FreeFresnel{c, epsilon}), nullptr,
        fit.x.data(), &fit.x[2 + c.theta_d]);
  }
  bound(problem, fit.x.data(), 0, 0, 1);
  bound(problem, fit.x.data(), 1, std::log(kLeastAlpha), 0);
  for (std::size_t d = 2; d < fit.x.size(); ++d) {
    if (problem.HasParameterBlock(&fit.x[d])) bound(problem, &fit.x[d], 0, 0, kUnbounded);
  }
}

std::vector<double> vector_of(const AnalyticFit& fit) {
  return {fit.albedo_d, fit.rho_0, fit.f_0, std::log(fit.alpha)};
}

std::vector<double> vector_of(const FreeFresnelFit& fit) {
  std::vector<double> x{fit.albedo_d, std::log(fit.alpha)};
  x.insert(x.end(), fit.factor.begin(), fit.factor.end());
  return x;
}

// As separation/diffuse_colour.cpp has them.
constexpr std::size_t kFreeStride = 7;
constexpr double kLeastCosine = 0.25;

}  // namespace

CeresFit ceres_eq_7(const CellTable& table, double epsilon, const AnalyticFit& start) {
  CeresFit fit{.x = vector_of(start)};
  const std::vector<Cell> cells = cells_of(table, epsilon, 1, 0);
  ceres::Problem problem;
  pose_eq_7(problem, cells, epsilon, fit);
  solve(problem, fit);
  return fit;
}

CeresFit cost_of_eq_7(const CellTable& table, double epsilon, const AnalyticFit& at) {
  CeresFit fit{.x = vector_of(at)};
  const std::vector<Cell> cells = cells_of(table, epsilon, 1, 0);
  ceres::Problem problem;
  pose_eq_7(problem, cells, epsilon, fit);
  evaluate(problem, fit);
  return fit;
}

CeresFit ceres_free_fresnel(const CellTable& table, double epsilon, const FreeFresnelFit& start) {
  CeresFit fit{.x = vector_of(start)};
  const std::vector<Cell> cells = cells_of(table, epsilon, kFreeStride, kLeastCosine);
  ceres::Problem problem;
  pose_free_fresnel(problem, cells, epsilon, fit);
  solve(problem, fit);
  return fit;
}

CeresFit cost_of_free_fresnel(const CellTable& table, double epsilon, const FreeFresnelFit& at) {
  CeresFit fit{.x = vector_of(at)};
  const std::vector<Cell> cells = cells_of(table, epsilon, kFreeStride, kLeastCosine);
  ceres::Problem problem;
  pose_free_fresnel(problem, cells, epsilon, fit);
  evaluate(problem, fit);
  return fit;
}

CeresFit ceres_two_lobes(const std::vector<ColourSample>& samples, double epsilon, double s_d, double s) {
  CeresFit fit{.x = {s_d, s}};
  ceres::Problem problem;
  problem.AddResidualBlock(new ColourCost(samples, epsilon, nullptr), nullptr, fit.x.data());
  bound(problem, fit.x.data(), 0, 0, kUnbounded);
  bound(problem, fit.x.data(), 1, 0, kUnbounded);
  solve(problem, fit);
  return fit;
}

CeresFit ceres_colour(const std::vector<ColourSample>& samples, double epsilon, double s_d, double s,
                      double highest) {
  CeresFit fit{.x = {std::clamp(s, 0.0, highest)}};
  ceres::Problem problem;
  problem.AddResidualBlock(new ColourCost(samples, epsilon, &s_d), nullptr, fit.x.data());
  bound(problem, fit.x.data(), 0, 0, highest);
  solve(problem, fit);
  return fit;
}

double cost_of_colours(const std::vector<ColourSample>& samples, double epsilon, double s_d, double s) {
  double sum = 0;
  for (const ColourSample& c : samples) {
    const double r = std::log((c.data + epsilon) / (s_d * c.diffuse + s * c.specular + epsilon));
    sum += r * r;
  }
  return sum / 2;
}

}  // namespace spectrace::test
