// SPDX-License-Identifier: Apache-2.0
#include "separation/analytic_fit.h"

#include <ceres/ceres.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "separation/parallel.h"

namespace spectrace {
namespace {

constexpr double kLeastAlpha = 1e-3;  // of AnalyticParameters
constexpr int kMaxIterations = 200;
constexpr double kRelativeTolerance = 1e-12;  // of cost and parameters: the sums carry 13 digits
// Every start is followed on one cell in seven (7 divides no grid dimension of the paper); the winner is then
// solved to the end on all of them.
constexpr std::size_t kScoutStride = 7;
// Root mean square log residual of Lambert alone below which a material is matte (hard case H9). A perfect
// Lambert measured through the grids of the real files comes back with 0.048, which eq. 12 with a = 1
// imitates better than Lambert does; of the real files none is below 0.31.
constexpr double kMatteResidual = 0.06;
constexpr int kAugmented = kFitParameters + 1;

/// The terms of eq. 12 that every cell of one (theta_h, theta_d) shares, with their derivatives.
struct Shared {
  double fresnel = 0, fresnel_df0 = 0;  // eq. 13
  double ndf = 0, ndf_dlog_a = 0;       // eq. 14, and the derivative of its logarithm by ln a
};

Shared shared_terms(const AnalyticFit& fit, double cos_h, double cos_d) {
  Shared s;
  const double schlick = std::pow(1 - cos_d, 5);
  s.fresnel = fit.f_0 + (1 - fit.f_0) * schlick;
  s.fresnel_df0 = 1 - schlick;
  const double a2 = fit.alpha * fit.alpha, cos2 = cos_h * cos_h;
  const double t = a2 * cos2 + (1 - cos2);  // (a² - 1) cos² + 1 without cancellation
  s.ndf = a2 / (std::numbers::pi * t * t);
  s.ndf_dlog_a = 2 - 4 * a2 * cos2 / t;
  return s;
}

/// G(θ) / (2 cosθ) of eq. 15, bounded by 1/a where G and cosθ both vanish; and the derivative of its log by
/// ln a.
struct Masking {
  double value = 0, dlog_a = 0;
};
Masking masking(double cosine, double a2) {
  const double tangent_part = a2 * (1 - cosine * cosine);
  const double root = std::sqrt(cosine * cosine + tangent_part);
  return {1 / (cosine + root), -tangent_part / (root * (cosine + root))};
}

/// The upper triangle of [J r]ᵀ[J r]: all that least squares needs, whatever the number of residuals.
using Gram = std::array<std::array<double, kAugmented>, kAugmented>;

/// `stride`: only every so many cells.
Gram group_gram(const CellTable& table, double epsilon, const AnalyticFit& fit, std::size_t group,
                std::size_t stride) {
  Gram gram{};
  const int h = static_cast<int>(group) / table.grid.n_theta_d,
            d = static_cast<int>(group) % table.grid.n_theta_d;
  const Shared s = shared_terms(fit, std::cos(table.grid.theta_h(h)), std::cos(table.grid.theta_d(d)));
  const double a2 = fit.alpha * fit.alpha;
  for (std::size_t i = table.begin[group]; i < table.begin[group + 1]; i += stride) {
    const double w = double(table.weight[i]);
    const Masking gi = masking(double(table.cos_i[i]), a2), go = masking(double(table.cos_o[i]), a2);
    const double unit = s.ndf * gi.value * go.value * w;  // eq. 12 without rho_0 and F
    const double specular = fit.rho_0 * s.fresnel * unit;
    const double model = fit.albedo_d / std::numbers::pi * w + specular + epsilon;
    std::array<double, kAugmented> row{w / std::numbers::pi, s.fresnel * unit,
                                       fit.rho_0 * s.fresnel_df0 * unit,
                                       specular * (s.ndf_dlog_a + gi.dlog_a + go.dlog_a), 0};
    for (double& x : row) x /= -model;  // r = ln(data) - ln(model)
    row[kFitParameters] = std::log((double(table.mean[i]) * w + epsilon) / model);
    for (int a = 0; a < kAugmented; ++a) {
      for (int b = a; b < kAugmented; ++b) gram[a][b] += row[a] * row[b];
    }
  }
  return gram;
}

Gram total_gram(const CellTable& table, double epsilon, const AnalyticFit& fit, std::size_t stride = 1) {
  std::vector<Gram> slices(std::size_t(table.grid.n_theta_h));
  const auto n_d = std::size_t(table.grid.n_theta_d);
  const auto add = [](Gram& to, const Gram& from) {
    for (int a = 0; a < kAugmented; ++a) {
      for (int b = a; b < kAugmented; ++b) to[a][b] += from[a][b];
    }
  };
  parallel_chunks(slices.size(), [&](std::size_t h) {
    for (std::size_t d = 0; d < n_d; ++d)
      add(slices[h], group_gram(table, epsilon, fit, h * n_d + d, stride));
  });
  Gram total{};
  for (const Gram& slice : slices) add(total, slice);
  return total;
}

/// The Cholesky factor of the Gram matrix: five rows with the cost, gradient and normal equations of all
/// residuals together, so that Ceres solves the full problem while seeing five of them.
Gram cholesky(const Gram& gram) {
  Gram r{};
  for (int k = 0; k < kAugmented; ++k) {
    double pivot = gram[k][k];
    for (int i = 0; i < k; ++i) pivot -= r[i][k] * r[i][k];
    // A column in the span of those before it (rho_0 = 0 makes F_0 and a vanish) leaves rounding: no row.
    constexpr double kRankTolerance = 1e-14;
    if (pivot <= kRankTolerance * gram[k][k]) continue;
    r[k][k] = std::sqrt(pivot);
    for (int j = k + 1; j < kAugmented; ++j) {
      double x = gram[k][j];
      for (int i = 0; i < k; ++i) x -= r[i][k] * r[i][j];
      r[k][j] = x / r[k][k];
    }
  }
  return r;
}

class CompressedCost final : public ceres::SizedCostFunction<kAugmented, kFitParameters> {
 public:
  CompressedCost(const CellTable& table, double epsilon, std::size_t stride)
      : table_(table), epsilon_(epsilon), stride_(stride) {}

  bool Evaluate(const double* const* parameters, double* residuals, double** jacobians) const override {
    FitVector x;
    std::copy_n(parameters[0], kFitParameters, x.begin());
    const Gram r = cholesky(total_gram(table_, epsilon_, from_vector(x), stride_));
    for (int i = 0; i < kAugmented; ++i) residuals[i] = r[i][kFitParameters];
    if (jacobians && jacobians[0]) {
      for (int i = 0; i < kAugmented; ++i) {
        for (int j = 0; j < kFitParameters; ++j) jacobians[0][i * kFitParameters + j] = r[i][j];
      }
    }
    return std::all_of(residuals, residuals + kAugmented, [](double v) { return std::isfinite(v); });
  }

 private:
  const CellTable& table_;
  double epsilon_;
  std::size_t stride_;
};

constexpr FitVector kLower{0, 0, 0, -6.907755278982137};  // ln kLeastAlpha
constexpr FitVector kUpper{1, std::numeric_limits<double>::infinity(), 1, 0};

double projected_gradient_max(const FitEquations& equations, const FitVector& x) {
  double largest = 0;
  for (int i = 0; i < kFitParameters; ++i) {
    const double g = equations.gradient[i];
    const bool held = (x[i] <= kLower[i] && g > 0) || (x[i] >= kUpper[i] && g < 0);
    if (!held) largest = std::max(largest, std::abs(g));
  }
  return largest;
}

struct Attempt {
  FitVector x{};
  double initial_cost = 0, cost = std::numeric_limits<double>::infinity();
  int iterations = 0;
  bool usable = false;
};

Attempt solve_from(const CellTable& table, double epsilon, const FitVector& start, std::size_t stride) {
  Attempt attempt{.x = start};
  ceres::Problem problem;
  problem.AddResidualBlock(new CompressedCost(table, epsilon, stride), nullptr, attempt.x.data());
  for (int i = 0; i < kFitParameters; ++i) {
    problem.SetParameterLowerBound(attempt.x.data(), i, kLower[i]);
    if (std::isfinite(kUpper[i])) problem.SetParameterUpperBound(attempt.x.data(), i, kUpper[i]);
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = kMaxIterations;
  options.function_tolerance = kRelativeTolerance;
  options.parameter_tolerance = kRelativeTolerance;
  options.gradient_tolerance = 0;  // scales with the number of cells: the two above decide
  options.num_threads = 1;         // the sum over cells is what runs in parallel
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  attempt.initial_cost = summary.initial_cost;
  attempt.cost = summary.final_cost;
  attempt.iterations = static_cast<int>(summary.iterations.size());
  attempt.usable = summary.termination_type == ceres::CONVERGENCE && std::isfinite(summary.final_cost);
  return attempt;
}

/// The albedo of the best Lambert BRDF alone: eq. 7 with rho_0 = 0, one unknown, by Gauss-Newton.
double fit_lambert(const CellTable& table, double epsilon, double start) {
  constexpr int kSteps = 20;
  FitVector x = to_vector({.albedo_d = start, .rho_0 = 0, .f_0 = 0, .alpha = 1});
  for (int step = 0; step < kSteps; ++step) {
    const FitEquations e = fit_equations(table, epsilon, x);
    if (!(e.hessian[0][0] > 0)) break;
    const double next = std::clamp(x[0] - e.gradient[0] / e.hessian[0][0], 0.0, 1.0);
    const bool converged = std::abs(next - x[0]) < kRelativeTolerance;
    x[0] = next;
    if (converged) break;
  }
  return x[0];
}

/// A level the diffuse part cannot be far from: most directions of most materials lie off the highlight.
double median_value(const CellTable& table) {
  std::vector<float> values = table.mean;
  const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return double(*middle);
}

}  // namespace

FitVector to_vector(const AnalyticFit& fit) {
  return {fit.albedo_d, fit.rho_0, fit.f_0, std::log(std::clamp(fit.alpha, kLeastAlpha, 1.0))};
}

AnalyticFit from_vector(const FitVector& x) {
  return {.albedo_d = x[0], .rho_0 = x[1], .f_0 = x[2], .alpha = std::exp(x[3])};
}

FitEquations fit_equations(const CellTable& table, double epsilon, const FitVector& x) {
  const Gram gram = total_gram(table, epsilon, from_vector(x));
  FitEquations equations;
  equations.cost = gram[kFitParameters][kFitParameters] / 2;
  for (int i = 0; i < kFitParameters; ++i) {
    equations.gradient[i] = gram[i][kFitParameters];
    for (int j = 0; j < kFitParameters; ++j) equations.hessian[i][j] = gram[std::min(i, j)][std::max(i, j)];
  }
  return equations;
}

AnalyticSolution fit_analytic(const CellTable& table, const SeparationOptions& options) {
  AnalyticSolution solution;
  if (table.fitted() == 0) return solution;
  // From satin to mirror: the cost has one valley per plausible roughness, and each start lies in another.
  constexpr std::array kStartAlpha{0.2, 0.05, 0.5, 0.01, 0.1, 0.9};
  const double diffuse = std::min(std::numbers::pi * median_value(table), 0.9);

  const AnalyticFit lambert{
      .albedo_d = fit_lambert(table, options.epsilon, diffuse), .rho_0 = 0, .f_0 = 0, .alpha = 1};
  const FitEquations matte = fit_equations(table, options.epsilon, to_vector(lambert));
  if (2 * matte.cost < kMatteResidual * kMatteResidual * double(table.fitted())) {
    solution.fit = lambert;
    solution.matte = solution.converged = true;
    solution.initial_cost = solution.final_cost = matte.cost;
    return solution;
  }

  Attempt scout;
  for (int s = 0; s < options.starts; ++s) {
    const AnalyticFit start{.albedo_d = s % 2 == 0 ? diffuse : diffuse / 2,
                            .rho_0 = 0.5,
                            .f_0 = 0.2,
                            .alpha = kStartAlpha[std::size_t(s) % kStartAlpha.size()]};
    const Attempt attempt = solve_from(table, options.epsilon, to_vector(start), kScoutStride);
    if (std::isfinite(attempt.cost) && attempt.cost < scout.cost) scout = attempt;
  }
  if (!std::isfinite(scout.cost)) return solution;
  const Attempt best = solve_from(table, options.epsilon, scout.x, 1);
  if (!std::isfinite(best.cost)) return solution;
  solution.converged = best.usable;
  solution.fit = from_vector(best.x);
  solution.fit.alpha = std::clamp(solution.fit.alpha, kLeastAlpha, 1.0);
  solution.initial_cost = best.initial_cost;
  solution.final_cost = best.cost;
  solution.iterations = best.iterations;
  solution.gradient_max =
      projected_gradient_max(fit_equations(table, options.epsilon, best.x), best.x) / double(table.fitted());
  return solution;
}

AnalyticFit refine_analytic(const CellTable& table, const SeparationOptions& options,
                            const AnalyticFit& start) {
  AnalyticFit fit = from_vector(solve_from(table, options.epsilon, to_vector(start), 1).x);
  fit.alpha = std::clamp(fit.alpha, kLeastAlpha, 1.0);
  return fit;
}

}  // namespace spectrace
