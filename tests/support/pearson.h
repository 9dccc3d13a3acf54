// SPDX-License-Identifier: Apache-2.0
// Pearson's chi-square test of counts.
#pragma once

#include <cstddef>
#include <vector>

namespace spectrace::test {

/// Probability that a chi-square variable of `degrees_of_freedom` exceeds `statistic`.
double chi_square_p_value(double statistic, double degrees_of_freedom);
/// Significance of each of `trials` tests so that all of them together have `alpha`: Šidák 1967.
double sidak_level(double alpha, std::size_t trials);

struct CellCount {
  double expected = 0, observed = 0;
};
struct PearsonTest {
  double statistic = 0, degrees_of_freedom = 0, p_value = 1;
};
/// Of `kept` observations against expected masses that sum to `integral` > 0. Cells that expect too few are
/// pooled.
PearsonTest test_shape(std::vector<CellCount> counts, double kept, double integral);

}  // namespace spectrace::test
