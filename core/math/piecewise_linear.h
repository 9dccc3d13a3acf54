// SPDX-License-Identifier: Apache-2.0
// Drawing from densities that are linear between nodes: the cell, then the place within it. In double,
// whatever Float is: where a density is tiny, nearly all of the mass lies on one side, and a table's last
// cells are interpolated with digits of 1 - x that single precision does not hold.
#pragma once

#include <algorithm>
#include <cmath>

namespace spectrace {

/// x clamped to [0, 1]; NaN becomes 0, and not an index out of a table.
constexpr double clamp_unit(double x) { return x > 0 ? std::min(x, 1.0) : 0.0; }

/// The last of the cells 0 ... cells - 1 whose cumulative start is at most `mass`: of cells without mass it
/// picks none, as long as `mass` is below the total. `cumulative(i)` is the mass below node i.
template <typename Cumulative>
int find_cell(int cells, double mass, const Cumulative& cumulative) {
  int low = 0, high = cells;
  while (high - low > 1) {
    const int middle = (low + high) / 2;
    (cumulative(middle) <= mass ? low : high) = middle;
  }
  return low;
}

/// The t in [0, 1] with integrate_linear(a, b, t) = area, for a density going linearly from a to b, both >=
/// 0. In this form of the root nothing cancels, whether a = b or a = 0.
inline double invert_linear(double a, double b, double area) {
  const double denominator = a + std::sqrt(std::max(a * a + 2 * (b - a) * area, 0.0));
  return denominator > 0 ? clamp_unit(2 * area / denominator) : 0.0;
}

/// The mass of that density over [0, t].
constexpr double integrate_linear(double a, double b, double t) { return t * (a + t * (b - a) / 2); }

}  // namespace spectrace
