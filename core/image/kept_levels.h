// SPDX-License-Identifier: Apache-2.0
// The coarse end of an image's levels, in memory. Internal to core/image.
#pragma once

#include <cstddef>
#include <vector>

#include "core/image/texels.h"

namespace spectrace {

/// Levels from `first` on, each the area means of the one before.
class KeptLevels {
 public:
  KeptLevels(const std::vector<TexelLevel>& levels, std::size_t first, std::size_t channels,
             std::vector<float> finest);
  /// `row_size`: numbers in a row of the level.
  [[nodiscard]] std::vector<float> rows(std::size_t level, int y0, int y1, std::size_t row_size) const;
  [[nodiscard]] std::size_t first() const { return first_; }

 private:
  std::size_t first_;
  std::vector<std::vector<float>> texels_;
};

/// Clamped to [0, 1]; NaN becomes 0.
[[nodiscard]] float usable_texel(float x);

}  // namespace spectrace
