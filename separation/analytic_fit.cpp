// SPDX-License-Identifier: Apache-2.0
#include "separation/analytic_fit.h"

#include <ceres/ceres.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/math/math.h"
#include "separation/lobe_equations.h"

namespace spectrace {
namespace {

constexpr int kMaxIterations = 200;
// Of cost and parameters. Near the end the gradient is the root of what the cost still has to lose: so far it
// is followed on all cells, less far where the result is a start, or is stored in single precision.
constexpr double kTolerance = 1e-14, kScoutTolerance = 1e-8, kSpectralTolerance = 1e-10;
// Every start is followed on one cell in seven (7 divides no grid dimension of the paper); the winner is then
// solved to the end on all of them.
constexpr std::size_t kScoutStride = 7;
// Root mean square log residual of Lambert alone below which a material is matte (hard case H9). A perfect
// Lambert measured through the grids of the real files comes back with 0.048, which eq. 12 with a = 1
// imitates better than Lambert does; of the real files none is below 0.31.
constexpr double kMatteResidual = 0.06;
/// The Cholesky factor of the Gram matrix: five rows with the cost, gradient and normal equations of all
/// residuals together, so that Ceres solves the full problem while seeing five of them.
Gram cholesky(const Gram& gram) {
  Gram r{};
  for (std::size_t k = 0; k < kAugmented; ++k) {
    double pivot = gram[k][k];
    for (std::size_t i = 0; i < k; ++i) pivot -= r[i][k] * r[i][k];
    // A column in the span of those before it (no specular lobe makes a vanish) leaves rounding: no row.
    constexpr double kRankTolerance = 1e-14;
    if (pivot <= kRankTolerance * gram[k][k]) continue;
    r[k][k] = std::sqrt(pivot);
    for (std::size_t j = k + 1; j < kAugmented; ++j) {
      double x = gram[k][j];
      for (std::size_t i = 0; i < k; ++i) x -= r[i][k] * r[i][j];
      r[k][j] = x / r[k][k];
    }
  }
  return r;
}

/// Where the sums over cells are taken.
enum class Sums { kInParallel, kOnThisThread };

class CompressedCost final : public ceres::SizedCostFunction<int(kAugmented), kFitParameters> {
 public:
  CompressedCost(const LobeCells& cells, double epsilon, Sums sums)
      : cells_(cells), epsilon_(epsilon), sums_(sums) {}

  bool Evaluate(const double* const* parameters, double* residuals, double** jacobians) const override {
    LobeVector x;
    std::copy_n(parameters[0], kFitParameters, x.begin());
    // Ceres asks for the residuals of a step, and if it takes it for the Jacobian at the same place.
    if (!has_last_ || x != last_x_) {
      last_ = cholesky(sums_ == Sums::kInParallel ? lobe_gram_in_parallel(cells_, epsilon_, x)
                                                  : lobe_gram(cells_, epsilon_, x));
      last_x_ = x;
      has_last_ = true;
    }
    const Gram& r = last_;
    for (std::size_t i = 0; i < kAugmented; ++i) residuals[i] = r[i][kFitParameters];
    if (jacobians && jacobians[0]) {
      for (std::size_t i = 0; i < kAugmented; ++i) {
        std::copy_n(r[i].begin(), kFitParameters, jacobians[0] + i * kFitParameters);
      }
    }
    return std::all_of(residuals, residuals + kAugmented, [](double v) { return std::isfinite(v); });
  }

 private:
  const LobeCells& cells_;
  double epsilon_;
  Sums sums_;
  mutable bool has_last_ = false;
  mutable LobeVector last_x_{};
  mutable Gram last_{};
};

constexpr double kUnbounded = std::numeric_limits<double>::infinity();
constexpr double kLogLeastAlpha = -6.907755278982137;
// Of the parameters as the paper has them, and as they are solved for.
constexpr FitVector kLower{0, 0, 0, kLogLeastAlpha}, kUpper{1, kUnbounded, 1, 0};
constexpr LobeVector kLobeLower{0, 0, 0, kLogLeastAlpha}, kLobeUpper{1, kUnbounded, kUnbounded, 0};

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
  LobeVector x{};
  double initial_cost = 0, cost = std::numeric_limits<double>::infinity();
  int iterations = 0;
  bool usable = false;
};

Attempt solve_from(const LobeCells& cells, double epsilon, const LobeVector& start, double tolerance,
                   Sums sums) {
  Attempt attempt{.x = start};
  ceres::Problem problem;
  problem.AddResidualBlock(new CompressedCost(cells, epsilon, sums), nullptr, attempt.x.data());
  for (int i = 0; i < kFitParameters; ++i) {
    problem.SetParameterLowerBound(attempt.x.data(), i, kLobeLower[i]);
    if (std::isfinite(kLobeUpper[i])) problem.SetParameterUpperBound(attempt.x.data(), i, kLobeUpper[i]);
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = kMaxIterations;
  options.function_tolerance = tolerance;
  options.parameter_tolerance = tolerance;
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
double fit_lambert(const LobeCells& cells, double epsilon, double start) {
  constexpr int kSteps = 20;
  constexpr double kAlbedoTolerance = 1e-6;
  LobeVector x{start, 0, 0, 0};
  for (int step = 0; step < kSteps; ++step) {
    const Gram gram = lobe_gram_in_parallel(cells, epsilon, x);
    if (!(gram[0][0] > 0)) break;
    const double next = std::clamp(x[0] - gram[0][kFitParameters] / gram[0][0], 0.0, 1.0);
    const bool converged = std::abs(next - x[0]) < kAlbedoTolerance;
    x[0] = next;
    if (converged) break;
  }
  return x[0];
}

AnalyticFit clamped(AnalyticFit fit) {
  fit.alpha = std::clamp(fit.alpha, kLeastAlpha, 1.0);
  return fit;
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

FitEquations fit_equations(const LobeCells& cells, double epsilon, const FitVector& x) {
  const Gram gram = lobe_gram_in_parallel(cells, epsilon, to_lobe(from_vector(x)));
  // p = rho_0 F_0 and q = rho_0 (1 - F_0) by the paper's parameters; the residual by itself.
  Gram by{};
  by[0][0] = by[3][3] = by[4][4] = 1;
  by[1][1] = x[2], by[1][2] = x[1];
  by[2][1] = 1 - x[2], by[2][2] = -x[1];
  Gram out{};
  for (std::size_t a = 0; a < kAugmented; ++a) {
    for (std::size_t b = 0; b < kAugmented; ++b) {
      for (std::size_t i = 0; i < kAugmented; ++i) {
        for (std::size_t j = 0; j < kAugmented; ++j) {
          out[a][b] += by[i][a] * gram[std::min(i, j)][std::max(i, j)] * by[j][b];
        }
      }
    }
  }
  FitEquations equations;
  equations.cost = out[kFitParameters][kFitParameters] / 2;
  for (int i = 0; i < kFitParameters; ++i) {
    equations.gradient[i] = out[i][kFitParameters];
    std::copy_n(out[i].begin(), kFitParameters, equations.hessian[i].begin());
  }
  return equations;
}

AnalyticSolution fit_analytic(const CellTable& table, const SeparationOptions& options) {
  AnalyticSolution solution;
  if (table.fitted() == 0) return solution;
  // From satin to mirror: the cost has one valley per plausible roughness, and each start lies in another.
  constexpr std::array kStartAlpha{0.2, 0.05, 0.5, 0.01, 0.1, 0.9};
  const double epsilon = options.epsilon;
  const LobeCells cells = lobe_cells(table, epsilon, 1), part = lobe_cells(table, epsilon, kScoutStride);
  const double diffuse = std::min(kPi64 * median_value(table), 0.9);

  const AnalyticFit lambert{.albedo_d = fit_lambert(cells, epsilon, fit_lambert(part, epsilon, diffuse)),
                            .rho_0 = 0,
                            .f_0 = 0,
                            .alpha = 1};
  const FitEquations matte = fit_equations(cells, epsilon, to_vector(lambert));
  if (2 * matte.cost < kMatteResidual * kMatteResidual * double(cells.size())) {
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
    const Attempt attempt = solve_from(part, epsilon, to_lobe(start), kScoutTolerance, Sums::kInParallel);
    if (std::isfinite(attempt.cost) && attempt.cost < scout.cost) scout = attempt;
  }
  if (!std::isfinite(scout.cost)) return solution;
  const Attempt best = solve_from(cells, epsilon, scout.x, kTolerance, Sums::kInParallel);
  if (!std::isfinite(best.cost)) return solution;
  solution.converged = best.usable;
  solution.fit = clamped(from_lobe(best.x));
  solution.initial_cost = best.initial_cost;
  solution.final_cost = best.cost;
  solution.iterations = best.iterations;
  const FitVector x = to_vector(solution.fit);
  solution.gradient_max = projected_gradient_max(fit_equations(cells, epsilon, x), x) / double(cells.size());
  return solution;
}

RefinedFit refine_analytic(const LobeCells& cells, const SeparationOptions& options,
                           const AnalyticFit& start) {
  const Attempt attempt =
      solve_from(cells, options.epsilon, to_lobe(start), kSpectralTolerance, Sums::kOnThisThread);
  return {.fit = clamped(from_lobe(attempt.x)), .cost = attempt.cost};
}

}  // namespace spectrace
