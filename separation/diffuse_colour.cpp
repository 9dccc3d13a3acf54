// SPDX-License-Identifier: Apache-2.0
#include "separation/diffuse_colour.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

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

/// One step of damped Gauss-Newton inside the bounds; the factors are eliminated first.
FreeFresnelFit stepped(const FreeFresnelFit& from, const Arrow& e, double damping) {
  constexpr double kLargestStep = 0.7;  // of ln alpha: a factor of two
  const double more = 1 + damping;
  double aa = e.aa * more, al = e.al, ll = e.ll * more, g_a = e.g_a, g_l = e.g_l;
  const auto is_held = [&](std::size_t d) { return !(e.ff[d] > 0) || (from.factor[d] <= 0 && e.g_f[d] > 0); };
  for (std::size_t d = 0; d < e.ff.size(); ++d) {
    if (is_held(d)) continue;
    const double inverse = 1 / (e.ff[d] * more);
    aa -= e.af[d] * e.af[d] * inverse, al -= e.af[d] * e.lf[d] * inverse, ll -= e.lf[d] * e.lf[d] * inverse;
    g_a -= e.af[d] * e.g_f[d] * inverse, g_l -= e.lf[d] * e.g_f[d] * inverse;
  }
  const double determinant = aa * ll - al * al;
  FreeFresnelFit to = from;
  if (determinant > 0) {
    to.albedo_d = std::clamp(from.albedo_d - (ll * g_a - al * g_l) / determinant, 0.0, 1.0);
    const double step = std::clamp(-(aa * g_l - al * g_a) / determinant, -kLargestStep, kLargestStep);
    to.alpha = std::clamp(from.alpha * std::exp(step), 1e-3, 1.0);  // bounds of AnalyticFit
  }
  const double d_a = to.albedo_d - from.albedo_d, d_l = std::log(to.alpha / from.alpha);
  for (std::size_t d = 0; d < e.ff.size(); ++d) {
    if (is_held(d)) continue;
    const double step = -(e.g_f[d] + e.af[d] * d_a + e.lf[d] * d_l) / (e.ff[d] * more);
    to.factor[d] = std::max(from.factor[d] + step, 0.0);
  }
  return to;
}

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
  constexpr int kMaxSteps = 40;
  constexpr double kFirstDamping = 1e-3, kLeastDamping = 1e-9, kMostDamping = 1e6;
  constexpr double kRelativeTolerance = 1e-9;  // of the cost: c_d moves by less than 1e-4 beyond it
  FreeFresnelFit best{.albedo_d = start.albedo_d, .alpha = start.alpha, .factor = {}};
  for (int d = 0; d < table.grid.n_theta_d; ++d) {
    const double schlick = std::pow(1 - std::cos(table.grid.theta_d(d)), 5);
    best.factor.push_back(start.rho_0 * (start.f_0 + (1 - start.f_0) * schlick));
  }
  Arrow equations = arrow_at(table, epsilon, best);
  double damping = kFirstDamping;
  for (int step = 0; step < kMaxSteps && damping < kMostDamping; ++step) {
    const FreeFresnelFit trial = stepped(best, equations, damping);
    Arrow at_trial = arrow_at(table, epsilon, trial);
    if (!(at_trial.cost < equations.cost)) {
      damping *= 10;
      continue;
    }
    const bool converged = equations.cost - at_trial.cost < kRelativeTolerance * equations.cost;
    best = trial;
    equations = std::move(at_trial);
    damping = std::max(damping / 10, kLeastDamping);
    if (converged) break;
  }
  return best;
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
