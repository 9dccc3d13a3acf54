// SPDX-License-Identifier: Apache-2.0
// Where a BSDF is tested that cares for no particular wavelengths.
#pragma once

#include <array>
#include <cstddef>

#include "materials/bsdf.h"

namespace spectrace::test {

inline const SampledWavelengths kLambda = [] {
  std::array<Float, kLanes> nm{}, pdf{};
  for (int i = 0; i < kLanes; ++i) nm[std::size_t(i)] = Float(420 + 80 * i);
  pdf.fill(1);
  return SampledWavelengths(nm, pdf);
}();
inline const ShadingPoint kAt{.lambda = kLambda};

}  // namespace spectrace::test
