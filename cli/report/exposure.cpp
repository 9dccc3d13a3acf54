// SPDX-License-Identifier: Apache-2.0
#include "cli/report/exposure.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace spectrace::cli {

double exposure_of(const Image& rgb) {
  constexpr double kWhitePoint = 0.98;
  std::vector<float> values;
  for (const float x : rgb.data) {
    if (x > 0 && std::isfinite(x)) values.push_back(x);  // the black behind says nothing
  }
  if (values.empty()) return 1;
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(kWhitePoint * double(values.size() - 1));
  std::nth_element(values.begin(), place, values.end());
  return 1 / double(*place);
}

}  // namespace spectrace::cli
