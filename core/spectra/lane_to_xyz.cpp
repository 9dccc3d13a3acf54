// SPDX-License-Identifier: Apache-2.0
#include "core/spectra/lane_to_xyz.h"

#include <cstddef>
#include <limits>

#include "core/base/wide.h"
#include "core/math/math.h"
#include "core/spectra/cie_tables.h"
#include "core/spectra/color.h"

namespace spectrace {
namespace {

using Weights = std::array<Float, 4>;

/// The observer's curves over ∫ȳ side by side, in the light path's own type.
class Bars {
 public:
  Bars() {
    for (std::size_t i = 0; i < kCieSamples; ++i) {
      const Xyz bar = cie_xyz_bar(kCieMinNm + double(i));
      for (std::size_t c = 0; c < 3; ++c) nodes_[i][c] = static_cast<Float>(bar[c] / cie_y_integral());
    }
    nodes_.back() = nodes_[kCieSamples - 1];
  }
  /// Linear between nodes, 0 outside, as cie_xyz_bar(); times `factor`.
  [[nodiscard]] Weights at(Float lambda_nm, Float factor) const {
    const Float position = lambda_nm - kCieMinNm;
    const Float inside = clamped(position, Float(0), Float(kCieSamples - 1));
    const auto i = static_cast<std::int32_t>(inside);
    const Float t = inside - Float(i), scale = inside == position ? factor : Float(0);
    const Float* const a = nodes_[static_cast<std::size_t>(i)].data();
    const Float* const b = a + Weights().size();
    Weights xyz;
    Float* const out = xyz.data();
    for (std::size_t c = 0; c < xyz.size(); ++c) out[c] = (a[c] + t * (b[c] - a[c])) * scale;
    return xyz;
  }

 private:
  alignas(sizeof(Weights)) std::array<Weights, kCieSamples + 1> nodes_{};  // the last twice
};

const Bars& bars() {
  static const Bars made;
  return made;
}

}  // namespace

LaneToXyz::LaneToXyz(const SampledWavelengths& lambda) { weigh(lambda); }

SPECTRACE_WIDE void LaneToXyz::weigh(const SampledWavelengths& lambda) {
  const Bars& observer = bars();
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    const Float pdf = lambda.pdf_per_nm(int(lane));
    counts_[lane] = pdf > 0 ? 1 : 0;
    weights_[lane] = observer.at(lambda.lambda_nm(int(lane)), pdf > 0 ? 1 / (pdf * kLanes) : Float(0));
  }
}

SPECTRACE_WIDE bool LaneToXyz::add(const LaneSums& radiance, PathXyz& xyz, bool may_be_negative) const {
  constexpr double kMost = std::numeric_limits<double>::max();
  const double least = may_be_negative ? -kMost : 0;
  const std::int32_t* const counts = counts_.data();
  std::array<double, kLanes> counted{};
  double* const values = counted.data();
  std::int32_t invalid = 0;
  const double* const lanes = radiance.v.data();
  for (int i = 0; i < kLanes; ++i) {
    // What a lane that does not count has become is nobody's concern: it may be infinite.
    values[i] = counts[i] != 0 ? lanes[i] : 0;
    invalid += values[i] >= least && values[i] <= kMost ? 0 : 1;
  }
  PathXyz sum = xyz;
  double* const out = sum.data();
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    const Float* const weights = weights_[lane].data();
    for (std::size_t c = 0; c < sum.size(); ++c) out[c] += double(weights[c]) * values[lane];
  }
  xyz = sum;
  return invalid == 0;
}

}  // namespace spectrace
