// SPDX-License-Identifier: Apache-2.0
// Prints the figures of core/spectra/rgb_basis.cpp. Run by hand (target derive_rgb_basis): the figures change
// only where this program, the observer or D65 does.
//
// Three spectra r, g, b, linear between nodes every 5 nm, that minimise the sum of squared second differences
// of all three, subject to r + g + b = 1 and r, g, b >= 0 at every node and to the colours of r and g under
// D65 being the sRGB primaries; b's is then right because white's is. A convex quadratic program in the
// spirit of Mallett & Yuksel 2019 (who minimise first differences), solved by the primal-dual active set
// method: Hintermueller, Ito & Kunisch 2002.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "core/spectra/cie_tables.h"
#include "core/spectra/color.h"

namespace spectrace {
namespace {

constexpr int kStepNm = 5;
constexpr std::size_t kNodes = std::size_t(kCieMaxNm - kCieMinNm) / kStepNm + 1;
constexpr std::size_t kUnknowns = 3 * kNodes;
constexpr std::size_t kEqualities = kNodes + 6;
constexpr int kMaxIterations = 100;  // takes 8
constexpr double kZero = 1e-12;      // what rounding leaves of the zeros

using Matrix = std::vector<std::vector<double>>;

/// Gaussian elimination with partial pivoting.
std::vector<double> solve(Matrix a, std::vector<double> b) {
  const std::size_t n = b.size();
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k + 1; i < n; ++i) {
      if (std::abs(a[i][k]) > std::abs(a[pivot][k])) pivot = i;
    }
    std::swap(a[k], a[pivot]);
    std::swap(b[k], b[pivot]);
    for (std::size_t i = k + 1; i < n; ++i) {
      const double factor = a[i][k] / a[k][k];
      if (factor == 0) continue;
      for (std::size_t j = k; j < n; ++j) a[i][j] -= factor * a[k][j];
      b[i] -= factor * b[k];
    }
  }
  for (std::size_t k = n; k-- > 0;) {
    for (std::size_t j = k + 1; j < n; ++j) b[k] -= a[k][j] * b[j];
    b[k] /= a[k][k];
  }
  return b;
}

/// RGB of a reflectance as a linear function of its node values: the quadrature of reflectance_to_xyz().
std::array<std::vector<double>, 3> color_weights() {
  std::array<std::vector<double>, 3> weights;
  weights.fill(std::vector<double>(kNodes));
  for (int nm = kCieMinNm; nm <= kCieMaxNm; ++nm) {
    const double end = nm == kCieMinNm || nm == kCieMaxNm ? 0.5 : 1;
    Xyz xyz = cie_xyz_bar(nm);
    for (double& x : xyz) x *= end * illuminant_d65(nm) / (d65_luminance() * cie_y_integral());
    const Rgb rgb = xyz_to_rgb(xyz);
    const double position = double(nm - kCieMinNm) / kStepNm;
    const auto i = std::min(static_cast<std::size_t>(position), kNodes - 2);
    for (std::size_t c = 0; c < 3; ++c) {
      weights[c][i] += (1 - (position - double(i))) * rgb[c];
      weights[c][i + 1] += (position - double(i)) * rgb[c];
    }
  }
  return weights;
}

Matrix smoothness() {
  Matrix h(kUnknowns, std::vector<double>(kUnknowns));
  const double stencil[3] = {1, -2, 1};
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t i = 0; i + 2 < kNodes; ++i) {
      for (std::size_t p = 0; p < 3; ++p) {
        for (std::size_t q = 0; q < 3; ++q)
          h[c * kNodes + i + p][c * kNodes + i + q] += stencil[p] * stencil[q];
      }
    }
  }
  return h;
}

struct Program {
  Matrix h = smoothness();                                         // minimise x·h·x / 2
  Matrix a = Matrix(kEqualities, std::vector<double>(kUnknowns));  // subject to a x = b, x >= 0
  std::vector<double> b = std::vector<double>(kEqualities);
};

Program make_program() {
  Program p;
  const auto weights = color_weights();
  for (std::size_t i = 0; i < kNodes; ++i) {
    for (std::size_t c = 0; c < 3; ++c) p.a[i][c * kNodes + i] = 1;
    p.b[i] = 1;
  }
  for (std::size_t spectrum = 0; spectrum < 2; ++spectrum) {
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t row = kNodes + spectrum * 3 + c;
      for (std::size_t i = 0; i < kNodes; ++i) p.a[row][spectrum * kNodes + i] = weights[c][i];
      p.b[row] = spectrum == c ? 1 : 0;
    }
  }
  return p;
}

/// The minimum with the unknowns marked `fixed` at 0, and the multipliers of the equalities.
std::pair<std::vector<double>, std::vector<double>> solve_fixed(const Program& p,
                                                                const std::vector<bool>& fixed) {
  const std::size_t n = kUnknowns + kEqualities;
  Matrix kkt(n, std::vector<double>(n));
  std::vector<double> right(n);
  for (std::size_t i = 0; i < kUnknowns; ++i) {
    if (fixed[i]) {
      kkt[i][i] = 1;
      continue;
    }
    for (std::size_t j = 0; j < kUnknowns; ++j) kkt[i][j] = p.h[i][j];
    for (std::size_t e = 0; e < kEqualities; ++e) kkt[i][kUnknowns + e] = p.a[e][i];
  }
  for (std::size_t e = 0; e < kEqualities; ++e) {
    for (std::size_t i = 0; i < kUnknowns; ++i) kkt[kUnknowns + e][i] = p.a[e][i];
    right[kUnknowns + e] = p.b[e];
  }
  const std::vector<double> all = solve(std::move(kkt), std::move(right));
  const auto split = all.begin() + static_cast<std::ptrdiff_t>(kUnknowns);
  return {{all.begin(), split}, {split, all.end()}};
}

std::vector<double> solve_program(const Program& p) {
  std::vector<bool> fixed(kUnknowns, false);
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    const auto [x, y] = solve_fixed(p, fixed);
    std::vector<bool> next(kUnknowns);
    for (std::size_t i = 0; i < kUnknowns; ++i) {
      double gradient = 0;  // >= 0 where the bound holds x back
      for (std::size_t j = 0; j < kUnknowns; ++j) gradient += p.h[i][j] * x[j];
      for (std::size_t e = 0; e < kEqualities; ++e) gradient += p.a[e][i] * y[e];
      next[i] = fixed[i] ? gradient > 0 : x[i] < 0;
    }
    if (next == fixed) return x;
    fixed = next;
  }
  return {};
}

}  // namespace
}  // namespace spectrace

int main() {
  using namespace spectrace;
  const std::vector<double> x = solve_program(make_program());
  if (x.empty()) {
    fmt::print(stderr, "the active sets did not settle\n");
    return 1;
  }
  for (std::size_t c = 0; c < 3; ++c) {
    std::string line = "   ";
    for (std::size_t i = 0; i < kNodes; ++i) {
      const std::string figure = fmt::format(" {:.9g},", x[c * kNodes + i] < kZero ? 0.0 : x[c * kNodes + i]);
      if (line.size() + figure.size() > 116) {
        fmt::print("{}\n", line);
        line = "   ";
      }
      line += figure;
    }
    fmt::print("{}\n\n", line);
  }
}
