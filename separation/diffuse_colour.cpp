// SPDX-License-Identifier: Apache-2.0
#include "separation/diffuse_colour.h"

#include <ceres/ceres.h>

#include <algorithm>
#include <cmath>

#include "core/math/math.h"
#include "separation/analytic_fit.h"
#include "separation/parallel.h"

namespace spectrace {
namespace {

// Nearer the horizon than 14.5 degrees measurements are worst and eq. 15 farthest from real masking.
constexpr double kLeastCosine = 0.25;
// The share of the cells that counts as "where the specular lobe is weakest".
constexpr double kDarkShare = 0.1;
// As in step 1: one cell in seven carries the fit's four dozen unknowns as well as all do.
constexpr std::size_t kStride = 7;
// Least determinant of the two equations: at 1 the dark cells are free of specular light, at 0 the lobe has
// the same share everywhere.
constexpr double kLeastContrast = 0.05;
// Of the fit's cost and unknowns: c_d moves by less than 1e-4 beyond it (optimality_test).
constexpr double kTolerance = 1e-10;
constexpr int kMaxIterations = 200;
// A theta_d whose highlight is darker than this, relative to the brightest, is read with all others together.
constexpr double kLeastHighlight = 1e-3;

bool is_well_above_horizon(const CellTable& table, std::size_t i) {
  return double(std::min(table.cos_i[i], table.cos_o[i])) >= kLeastCosine;
}

/// Eq. 12 without rho_0 and F.
double shape(double alpha, double cos_h, double cos_i, double cos_o) {
  return analytic_specular({.albedo_d = 0, .rho_0 = 1, .f_0 = 1, .alpha = alpha}, cos_h, 1, cos_i, cos_o);
}

/// Calls body(i, d, cos_h) for the cells well above the horizon of one theta_h.
template <typename F>
void for_cells(const CellTable& table, std::size_t h, std::size_t stride, const F& body) {
  const auto n_d = std::size_t(table.grid.n_theta_d);
  const double cos_h = std::cos(table.grid.theta_h(double(h)));
  for (std::size_t d = 0; d < n_d; ++d) {
    for (std::size_t i = table.begin[h * n_d + d]; i < table.begin[h * n_d + d + 1]; i += stride) {
      if (is_well_above_horizon(table, i)) body(i, d, cos_h);
    }
  }
}

/// The normal equations over (albedo_d, ln alpha, factor): an arrow, since no residual has two factors.
struct Arrow {
  double cost = 0, g_a = 0, g_l = 0, aa = 0, al = 0, ll = 0;
  std::vector<double> g_f, ff, af, lf;  // [theta_d]

  explicit Arrow(std::size_t n) : g_f(n), ff(n), af(n), lf(n) {}
  void add(const Arrow& o) {
    cost += o.cost, g_a += o.g_a, g_l += o.g_l, aa += o.aa, al += o.al, ll += o.ll;
    for (std::size_t d = 0; d < ff.size(); ++d) {
      g_f[d] += o.g_f[d], ff[d] += o.ff[d], af[d] += o.af[d], lf[d] += o.lf[d];
    }
  }
};

Arrow arrow_at(const CellTable& table, double epsilon, const FreeFresnelFit& fit) {
  constexpr double kStep = 1e-4;  // of ln alpha; its error, 1e-8 relative, is that of single precision
  const double alpha_above = fit.alpha * std::exp(kStep), alpha_below = fit.alpha * std::exp(-kStep);
  const auto n_d = std::size_t(table.grid.n_theta_d);
  std::vector<Arrow> slices(std::size_t(table.grid.n_theta_h), Arrow(n_d));
  parallel_chunks(slices.size(), [&](std::size_t h) {
    Arrow& s = slices[h];
    for_cells(table, h, kStride, [&](std::size_t i, std::size_t d, double cos_h) {
      const double w = double(table.weight[i]), cos_i = double(table.cos_i[i]),
                   cos_o = double(table.cos_o[i]);
      const double k = shape(fit.alpha, cos_h, cos_i, cos_o) * w;
      const double dk = (shape(alpha_above, cos_h, cos_i, cos_o) - shape(alpha_below, cos_h, cos_i, cos_o)) *
                        w / (2 * kStep);
      const double model = fit.albedo_d / kPi64 * w + fit.factor[d] * k + epsilon;
      const double r = std::log((double(table.mean[i]) * w + epsilon) / model);
      const double j_a = -w / kPi64 / model, j_l = -fit.factor[d] * dk / model, j_f = -k / model;
      s.cost += r * r;
      s.g_a += j_a * r, s.g_l += j_l * r, s.g_f[d] += j_f * r;
      s.aa += j_a * j_a, s.al += j_a * j_l, s.ll += j_l * j_l;
      s.ff[d] += j_f * j_f, s.af[d] += j_a * j_f, s.lf[d] += j_l * j_f;
    });
  });
  Arrow sum(n_d);
  for (const Arrow& s : slices) sum.add(s);
  return sum;
}

/// The Cholesky factor of the normal equations, factors first, and its last column: as many residuals as
/// unknowns and one more, with the cost, gradient and normal equations of all cells together, so that Ceres
/// solves the full problem while seeing these (as in step 1). Unknowns: a factor for each theta_d, albedo_d,
/// ln alpha.
class FreeFresnelCost final : public ceres::CostFunction {
 public:
  FreeFresnelCost(const CellTable& table, double epsilon) : table_(table), epsilon_(epsilon) {
    const int n_d = table.grid.n_theta_d;
    set_num_residuals(n_d + 3);
    mutable_parameter_block_sizes()->push_back(n_d + 2);
  }

  static FreeFresnelFit fit_of(const double* x, std::size_t n_d) {
    return {.albedo_d = x[n_d], .alpha = std::exp(x[n_d + 1]), .factor = std::vector<double>(x, x + n_d)};
  }

  bool Evaluate(const double* const* parameters, double* residuals, double** jacobians) const override {
    const auto n_d = std::size_t(table_.grid.n_theta_d), columns = n_d + 2;
    const Arrow& e = equations_at(parameters[0]);
    double* const jacobian = jacobians ? jacobians[0] : nullptr;
    if (jacobian) std::fill(jacobian, jacobian + (n_d + 3) * columns, 0.0);
    const auto set = [&](std::size_t row, std::size_t column, double value) {
      if (jacobian) jacobian[row * columns + column] = value;
    };
    double aa = e.aa, al = e.al, ll = e.ll, g_a = e.g_a, g_l = e.g_l, rest = e.cost;
    for (std::size_t d = 0; d < n_d; ++d) {
      residuals[d] = 0;
      if (!(e.ff[d] > 0)) continue;  // no cell has this factor
      const double pivot = std::sqrt(e.ff[d]), to_a = e.af[d] / pivot, to_l = e.lf[d] / pivot;
      residuals[d] = e.g_f[d] / pivot;
      set(d, d, pivot), set(d, n_d, to_a), set(d, n_d + 1, to_l);
      aa -= to_a * to_a, al -= to_a * to_l, ll -= to_l * to_l;
      g_a -= to_a * residuals[d], g_l -= to_l * residuals[d], rest -= residuals[d] * residuals[d];
    }
    const double pivot_a = std::sqrt(std::max(aa, kRankTolerance * e.aa));
    const double a_to_l = pivot_a > 0 ? al / pivot_a : 0;
    residuals[n_d] = pivot_a > 0 ? g_a / pivot_a : 0;
    set(n_d, n_d, pivot_a), set(n_d, n_d + 1, a_to_l);
    const double pivot_l = std::sqrt(std::max(ll - a_to_l * a_to_l, kRankTolerance * e.ll));
    residuals[n_d + 1] = pivot_l > 0 ? (g_l - a_to_l * residuals[n_d]) / pivot_l : 0;
    set(n_d + 1, n_d + 1, pivot_l);
    rest -= residuals[n_d] * residuals[n_d] + residuals[n_d + 1] * residuals[n_d + 1];
    residuals[n_d + 2] = std::sqrt(std::max(rest, 0.0));
    return std::all_of(residuals, residuals + n_d + 3, [](double r) { return std::isfinite(r); });
  }

 private:
  // Where albedo_d or ln alpha is all but in the span of the others, rounding is left of its pivot.
  static constexpr double kRankTolerance = 1e-14;

  /// Ceres asks for the residuals of a step, and if it takes it for the Jacobian at the same place.
  const Arrow& equations_at(const double* x) const {
    const auto n_d = std::size_t(table_.grid.n_theta_d);
    if (!std::equal(last_x_.begin(), last_x_.end(), x, x + n_d + 2)) {
      last_ = arrow_at(table_, epsilon_, fit_of(x, n_d));
      last_x_.assign(x, x + n_d + 2);
    }
    return last_;
  }

  const CellTable& table_;
  double epsilon_;
  mutable std::vector<double> last_x_;
  mutable Arrow last_{0};
};

/// What the two equations need of each cell well above the horizon.
struct Cells {
  std::vector<std::size_t> index, theta_d;
  std::vector<double> shape, solid_angle;
};

Cells cells_of(const CellTable& table, double alpha) {
  Cells cells;
  const HalfDifferenceGrid& grid = table.grid;
  for (std::size_t h = 0; h < std::size_t(grid.n_theta_h); ++h) {
    const double step = grid.theta_h(double(h) + 0.5) - grid.theta_h(std::max(double(h) - 0.5, 0.0));
    const double solid_angle = std::sin(grid.theta_h(double(h))) * step;
    for_cells(table, h, 1, [&](std::size_t i, std::size_t d, double cos_h) {
      cells.index.push_back(i);
      cells.theta_d.push_back(d);
      cells.shape.push_back(shape(alpha, cos_h, double(table.cos_i[i]), double(table.cos_o[i])));
      cells.solid_angle.push_back(solid_angle);
    });
  }
  return cells;
}

/// The level below which a kDarkShare of the shapes lies.
double dark_level(std::vector<double> shapes) {
  const auto at = shapes.begin() + std::ptrdiff_t(double(shapes.size()) * kDarkShare);
  std::nth_element(shapes.begin(), at, shapes.end());
  return *at;
}

/// Σ weight · f̂ over cells as Σ weight · spectrum over rows of the measurement.
std::vector<double> row_weights(const CellTable& table, const Cells& cells, const std::vector<double>& weight,
                                std::size_t rows) {
  std::vector<double> out(rows);
  for (std::size_t c = 0; c < weight.size(); ++c) {
    const std::size_t i = cells.index[c];
    const double scale = weight[c] / double(table.weight[i]);
    for (std::size_t n = table.node_begin[i]; n < table.node_begin[i + 1]; ++n) {
      out[table.node_row[n]] += scale * double(table.node_weight[n]);
    }
  }
  return out;
}

/// With x = c/π + φ_d(λ) G over the cells: for the dark ones, mean x = c/π + Σ_d φ_d L_d; for the highlight
/// of each theta_d, Σ v x = (c/π) Σ v + φ_d M_d. Eliminating φ_d leaves c/π as Σ weight · x; empty where it
/// is not determined.
std::vector<double> cell_weights(const CellTable& table, const Cells& cells, const FreeFresnelFit& fit) {
  const std::size_t n_d = fit.factor.size(), n = cells.index.size();
  const double lambert = fit.albedo_d / kPi64, level = dark_level(cells.shape);
  std::vector<double> v(n), dark(n_d), weight_sum(n_d), highlight(n_d);
  double dark_count = 0;
  for (std::size_t c = 0; c < n; ++c) {
    const std::size_t i = cells.index[c], d = cells.theta_d[c];
    const double specular = fit.factor[d] * cells.shape[c];
    if (cells.shape[c] <= level) dark[d] += specular, ++dark_count;
    if (specular <= 0) continue;
    const double share = specular / (specular + lambert);
    // The third power keeps to the highlight itself.
    v[c] = share * share * share * cells.solid_angle[c] * double(table.cos_i[i]) * double(table.cos_o[i]);
    weight_sum[d] += v[c];
    highlight[d] += v[c] * (double(table.mean[i]) - lambert);
  }
  const double brightest = *std::max_element(highlight.begin(), highlight.end());
  double pooled_dark = 0, pooled_weight = 0, pooled_highlight = 0, contrast = 1;
  std::vector<double> ratio(n_d);
  for (std::size_t d = 0; d < n_d; ++d) {
    dark[d] /= dark_count;
    pooled_weight += weight_sum[d];
    pooled_highlight += highlight[d];
    if (highlight[d] > kLeastHighlight * brightest) {
      ratio[d] = dark[d] / highlight[d];
      contrast -= ratio[d] * weight_sum[d];
    } else {
      pooled_dark += dark[d];
    }
  }
  const double pooled_ratio = pooled_highlight > 0 ? pooled_dark / pooled_highlight : 0;
  contrast -= pooled_ratio * pooled_weight;
  if (!(contrast > kLeastContrast)) return {};
  for (std::size_t c = 0; c < n; ++c) {
    const double of_dark = cells.shape[c] <= level ? 1 / dark_count : 0;
    v[c] = (of_dark - v[c] * (ratio[cells.theta_d[c]] + pooled_ratio)) / contrast;
  }
  return v;
}

}  // namespace

FreeFresnelFit fit_free_fresnel(const CellTable& table, double epsilon, const AnalyticFit& start) {
  const auto n_d = std::size_t(table.grid.n_theta_d);
  std::vector<double> x;
  for (std::size_t d = 0; d < n_d; ++d) {
    const double schlick = std::pow(1 - std::cos(table.grid.theta_d(double(d))), 5);
    x.push_back(start.rho_0 * (start.f_0 + (1 - start.f_0) * schlick));
  }
  x.push_back(start.albedo_d);
  x.push_back(std::log(start.alpha));
  ceres::Problem problem;
  problem.AddResidualBlock(new FreeFresnelCost(table, epsilon), nullptr, x.data());
  for (int i = 0; i < int(n_d) + 1; ++i) problem.SetParameterLowerBound(x.data(), i, 0);
  problem.SetParameterUpperBound(x.data(), int(n_d), 1);
  problem.SetParameterLowerBound(x.data(), int(n_d) + 1, std::log(kLeastAlpha));
  problem.SetParameterUpperBound(x.data(), int(n_d) + 1, 0);
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = kMaxIterations;
  options.function_tolerance = kTolerance;
  options.parameter_tolerance = kTolerance;
  options.gradient_tolerance = 0;  // scales with the number of cells
  options.num_threads = 1;         // the sum over cells is what runs in parallel
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  FreeFresnelFit fit = FreeFresnelCost::fit_of(x.data(), n_d);
  fit.converged = summary.termination_type == ceres::CONVERGENCE;
  return fit;
}

std::optional<std::vector<float>> diffuse_colour(const MeasuredBrdf& measured, const CellTable& table,
                                                 const FreeFresnelFit& fit) {
  const Cells cells = cells_of(table, fit.alpha);
  if (cells.index.empty()) return std::nullopt;
  const std::vector<double> weight = cell_weights(table, cells, fit);
  if (weight.empty()) return std::nullopt;
  const MeasuredTables& tables = measured.tables();
  const std::size_t rows = tables.slices() * std::size_t(tables.table_size) * std::size_t(tables.table_size);
  const std::vector<double> of_row = row_weights(table, cells, weight, rows);
  std::vector<double> sum(measured.axis().size());
  for (std::size_t r = 0; r < rows; ++r) {
    if (of_row[r] == 0) continue;
    const float* spectrum = measured.spectrum(static_cast<std::uint32_t>(r));
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += of_row[r] * double(spectrum[k]);
  }
  std::vector<float> c_d(sum.size());
  for (std::size_t k = 0; k < sum.size(); ++k) {
    c_d[k] = static_cast<float>(std::max(kPi64 * sum[k], 0.0));
  }
  return c_d;
}

}  // namespace spectrace
