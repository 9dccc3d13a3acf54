// SPDX-License-Identifier: Apache-2.0
#include "core/spectra/lane_to_xyz.h"

#include <cmath>

namespace spectrace {

LaneToXyz::LaneToXyz(const SampledWavelengths& lambda) {
  for (int lane = 0; lane < kLanes; ++lane) {
    const double pdf = lambda.pdf_per_nm(lane);
    counts_[lane] = pdf > 0;
    if (!counts_[lane]) {
      continue;
    }
    const Xyz bar = cie_xyz_bar(lambda.lambda_nm(lane));
    const double scale = 1 / (pdf * kLanes * cie_y_integral());
    weight_[lane] = {bar[0] * scale, bar[1] * scale, bar[2] * scale};
  }
}

bool LaneToXyz::add(const LaneSums& sums, Xyz& xyz, bool may_be_negative) const {
  bool valid = true;
  for (int lane = 0; lane < kLanes; ++lane) {
    if (!counts_[lane]) {
      continue;
    }
    valid &= std::isfinite(sums.v[lane]) && (may_be_negative || sums.v[lane] >= 0);
    for (int c = 0; c < 3; ++c) {
      xyz[c] += weight_[lane][c] * sums.v[lane];
    }
  }
  return valid;
}

}  // namespace spectrace
