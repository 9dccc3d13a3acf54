// SPDX-License-Identifier: Apache-2.0
// Does a sampler over the upper hemisphere draw what its density says? Pearson's chi-square over cells, and
// the share of samples kept against the density's integral. Knows nothing of BSDFs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "core/math/vec.h"
#include "tests/support/pearson.h"

namespace spectrace::test {

/// Uniform numbers in [0, 1), the same on every platform: SplitMix64 (Steele et al. 2014).
class TestRandom {
 public:
  explicit TestRandom(std::uint64_t seed) : state_(seed) {}
  Float uniform();
  Vec2 uniform2() {
    const Float x = uniform();
    return {x, uniform()};
  }

 private:
  std::uint64_t next();
  std::uint64_t state_;
};

/// Draws a direction of z > 0, or nothing where the sample is lost.
using DrawDirection = std::function<std::optional<Vec3>(TestRandom&)>;
/// Density per solid angle [1/sr].
using DirectionDensity = std::function<double(Vec3)>;

struct SamplingTestOptions {
  std::size_t samples = 1'000'000;
  /// Decide where cells go; independent of the samples tested. Cells then hold about
  /// samples · pilot_per_cell / pilots of them each, however narrow the lobe.
  std::size_t pilots = 25'000;
  std::size_t pilots_per_cell = 25;
  /// Relative, of each leaf's integral. A systematic error ε adds samples · ε² = 1 to a statistic whose
  /// standard deviation is sqrt(2 · 1000 cells) = 45.
  double quadrature_tolerance = 1e-3;
  std::uint64_t seed = 1;
  Vec3 azimuth_zero{1, 0, 0};  ///< cells are cut at the azimuth opposite to it: point it at the lobe
  /// Beside the cells, as many bins of one size over the hemisphere: rows of equal height in cosθ, columns in
  /// azimuth; 0: none. The same samples are counted in both.
  std::size_t bin_rows = 0, bin_columns = 0;
};

struct SamplingTestResult {
  double statistic = 0, degrees_of_freedom = 0;
  double p_value = 1;         ///< of the shape: kept samples over cells against the density's cell integrals
  double p_value_bins = 1;    ///< of the shape over the bins of one size, where asked for
  double integral = 0;        ///< of the density over the hemisphere
  double integral_error = 0;  ///< the quadrature's own estimate
  double kept = 0;            ///< share of samples not lost
  double p_value_kept = 1;    ///< of kept = integral, beyond integral_error
  std::size_t below_horizon = 0;  ///< samples with z <= 0: a defect
  std::size_t cells = 0, evaluations = 0;

  [[nodiscard]] std::string text() const;
};

SamplingTestResult test_sampling(const DrawDirection& draw, const DirectionDensity& density,
                                 const SamplingTestOptions& options);

}  // namespace spectrace::test
