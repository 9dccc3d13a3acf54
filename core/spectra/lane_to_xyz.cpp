// SPDX-License-Identifier: Apache-2.0
#include "core/spectra/lane_to_xyz.h"

#include <cstddef>
#include <cstring>
#include <limits>

#include "core/base/wide.h"
#include "core/math/math.h"
#include "core/spectra/cie_tables.h"
#include "core/spectra/color.h"

namespace spectrace {
namespace {

using Weights = std::array<Float, 4>;
/// The same in one register: GCC 12 makes none of a loop over weights that may overlap with what they are
/// made from.
using Four = Float __attribute__((vector_size(sizeof(Weights))));

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
  /// Linear between nodes, 0 outside, as cie_xyz_bar(); times `factor`, one a lane.
  void at(const SampledSpectrum& lambda_nm, const SampledSpectrum& factor,
          std::array<Weights, kLanes>& weights) const {
    const auto inside = SampledSpectrum::by_lane(
        [](Float nm) { return clamped(nm - kCieMinNm, Float(0), Float(kCieSamples - 1)); }, lambda_nm);
    const auto scale = SampledSpectrum::by_lane(
        [](Float nm, Float place, Float f) { return place == nm - kCieMinNm ? f : Float(0); }, lambda_nm,
        inside, factor);
    for (int lane = 0; lane < kLanes; ++lane) {
      const auto i = static_cast<std::int32_t>(inside[lane]);
      const Float t = inside[lane] - Float(i);
      const Weights* const node = &nodes_[static_cast<std::size_t>(i)];
      Four a, b;
      std::memcpy(&a, node, sizeof(a));
      std::memcpy(&b, node + 1, sizeof(b));
      const Four weight = (a + t * (b - a)) * scale[lane];
      std::memcpy(&weights[static_cast<std::size_t>(lane)], &weight, sizeof(weight));
    }
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
  SampledSpectrum nm, factor;
  Float* const nm_of = nm.v.data();
  Float* const factor_of = factor.v.data();
  for (int lane = 0; lane < kLanes; ++lane) {
    const Float pdf = lambda.pdf_per_nm(lane);
    counts_[std::size_t(lane)] = pdf > 0 ? 1 : 0;
    nm_of[lane] = lambda.lambda_nm(lane);
    factor_of[lane] = pdf > 0 ? 1 / (pdf * kLanes) : Float(0);
  }
  bars().at(nm, factor, weights_);
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
