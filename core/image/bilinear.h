// SPDX-License-Identifier: Apache-2.0
// Where a texture coordinate falls between the texels of an image that repeats.
#pragma once

#include <cmath>
#include <cstddef>

#include "core/math/vec.h"

namespace spectrace {

/// The two texels around a coordinate of period 1 and the weight of the second.
struct Tap {
  std::size_t first = 0, second = 0;
  double weight = 0;

  Tap() = default;
  Tap(Float coordinate, int texels) {
    if (!std::isfinite(coordinate)) return;
    const double x =
        (double(coordinate) - std::floor(double(coordinate))) * texels - 0.5;  // texel centres at .5
    const double below = std::floor(x);
    const auto wrapped = [texels](double i) {
      const int k = static_cast<int>(i) % texels;
      return static_cast<std::size_t>(k < 0 ? k + texels : k);
    };
    first = wrapped(below);
    second = wrapped(below + 1);
    weight = x - below;
  }
};

/// The four texels around a point and their weights; v = 0 at the bottom row.
class Bilinear {
 public:
  Bilinear(Vec2 uv, int width, int height)
      : x_(uv.x, width), y_(-uv.y, height) {}  // rows run from the top, v from the bottom

  /// `texel(row, column)` is a number.
  template <typename Texel>
  [[nodiscard]] double mean(const Texel& texel) const {
    const double above = (1 - x_.weight) * texel(y_.first, x_.first) + x_.weight * texel(y_.first, x_.second);
    const double below =
        (1 - x_.weight) * texel(y_.second, x_.first) + x_.weight * texel(y_.second, x_.second);
    return (1 - y_.weight) * above + y_.weight * below;
  }

 private:
  Tap x_, y_;
};

}  // namespace spectrace
