// SPDX-License-Identifier: Apache-2.0
// The coarse end of an image's levels, in memory. Internal to core/image.
#pragma once

#include <cstddef>
#include <vector>

#include "core/image/texels.h"

namespace spectrace {

/// Levels from `first` on.
class KeptLevels {
 public:
  /// `finest`: the first of them, from which the next ones may be given too; the others are area means of the
  /// one before.
  KeptLevels(const std::vector<TexelLevel>& levels, std::size_t first, std::size_t channels,
             std::vector<std::vector<float>> finest);
  /// `row_size`: numbers in a row of the level.
  [[nodiscard]] std::vector<float> rows(std::size_t level, int y0, int y1, std::size_t row_size) const;
  [[nodiscard]] std::size_t first() const { return first_; }

 private:
  std::size_t first_;
  std::vector<std::vector<float>> texels_;
};

/// What images of files that are kept whole may take, all together. Those that do not fit, when they are
/// loaded, are read again as they are needed.
void set_kept_limit(std::size_t bytes);

/// Clamped to [0, 1]; NaN becomes 0.
[[nodiscard]] float usable_texel(float x);

}  // namespace spectrace
