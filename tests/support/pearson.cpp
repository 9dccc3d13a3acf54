// SPDX-License-Identifier: Apache-2.0
#include "tests/support/pearson.h"

#include <algorithm>
#include <cmath>

namespace spectrace::test {

namespace {

/// Below this many expected samples Pearson's statistic is no chi-square: such cells are pooled (Cochran
/// 1954).
constexpr double kMinExpected = 5;

/// Pools cells that expect too few samples, with the least of the others where that is still too few.
void pool(std::vector<CellCount>& cells) {
  std::sort(cells.begin(), cells.end(), [](CellCount a, CellCount b) { return a.expected < b.expected; });
  CellCount pooled = cells.front();
  auto next = cells.begin() + 1;
  for (; next != cells.end() && (next->expected < kMinExpected || pooled.expected < kMinExpected); ++next) {
    pooled.expected += next->expected;
    pooled.observed += next->observed;
  }
  cells.erase(cells.begin() + 1, next);
  cells.front() = pooled;
}

/// Regularised upper incomplete gamma function: series below, continued fraction (Lentz) above the mean.
double upper_gamma(double a, double x) {
  constexpr double kTiny = 1e-300, kPrecision = 1e-14;
  if (x <= 0) return 1;
  const double scale = std::exp(a * std::log(x) - x - std::lgamma(a));
  if (x < a + 1) {
    double term = 1 / a, sum = term;
    for (double n = a + 1; std::abs(term) > kPrecision * sum; ++n) sum += term *= x / n;
    return 1 - scale * sum;
  }
  double b = x + 1 - a, c = 1 / kTiny, d = 1 / b, h = d;
  for (double i = 1;; ++i) {
    const double an = -i * (i - a);
    b += 2;
    d = an * d + b;
    d = 1 / (std::abs(d) < kTiny ? kTiny : d);
    c = b + an / c;
    c = std::abs(c) < kTiny ? kTiny : c;
    const double delta = d * c;
    h *= delta;
    if (std::abs(delta - 1) < kPrecision) return scale * h;
  }
}

}  // namespace

double chi_square_p_value(double statistic, double degrees_of_freedom) {
  if (!std::isfinite(statistic)) return 0;
  return upper_gamma(degrees_of_freedom / 2, statistic / 2);
}

double sidak_level(double alpha, std::size_t trials) {
  return -std::expm1(std::log1p(-alpha) / static_cast<double>(trials));
}

PearsonTest test_shape(std::vector<CellCount> counts, double kept, double integral) {
  for (CellCount& c : counts) c.expected *= kept / integral;
  pool(counts);
  PearsonTest shape;
  for (const CellCount& c : counts) {
    const double difference = c.observed - c.expected;
    shape.statistic += difference * difference / std::max(c.expected, 1e-3);
  }
  shape.degrees_of_freedom = std::max(static_cast<double>(counts.size()) - 1, 1.0);
  shape.p_value = chi_square_p_value(shape.statistic, shape.degrees_of_freedom);
  return shape;
}

}  // namespace spectrace::test
