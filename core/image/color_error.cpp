// SPDX-License-Identifier: Apache-2.0
#include "core/image/color_error.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/spectra/color.h"
#include "core/spectra/color_difference.h"

namespace spectrace {

double mean_ciede2000(const Image& reference, const Image& test, double exposure) {
  SPECTRACE_CHECK(reference.channels.size() == 3 && test.channels.size() == 3 &&
                  reference.width == test.width && reference.data.size() == test.data.size() &&
                  !test.data.empty());
  const Xyz white = rgb_to_xyz({1, 1, 1});
  const auto lab = [&](const float* pixel) {
    Rgb shown{};
    for (std::size_t c = 0; c < 3; ++c) shown[c] = std::clamp(exposure * double(pixel[c]), 0.0, 1.0);
    return xyz_to_lab(rgb_to_xyz(shown), white);
  };
  double sum = 0;
  for (std::size_t i = 0; i < test.data.size(); i += 3) {
    sum += ciede2000(lab(&reference.data[i]), lab(&test.data[i]));
  }
  return sum * 3 / double(test.data.size());
}

}  // namespace spectrace
