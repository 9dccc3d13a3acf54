// SPDX-License-Identifier: Apache-2.0
// Coarser versions of an image, row by row.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace spectrace {

/// Rows [y0, y1) of an image of `coarse` texels, each the mean of the finer image over its area: the mean of
/// the whole is kept whatever the sizes. Exact but for the rounding of doubles.
class AreaMeans {
 public:
  struct Size {
    int width = 0, height = 0;
  };
  /// No side of `coarse` is longer than that of `fine`.
  AreaMeans(Size fine, Size coarse, int y0, int y1, std::size_t channels);

  /// Rows [first_row, last_row) of the finer image take part, each to be added once, in any order.
  [[nodiscard]] int first_row() const { return first_row_; }
  [[nodiscard]] int last_row() const { return last_row_; }
  void add(int row, const float* texels);
  [[nodiscard]] std::vector<float> means() const { return {sums_.begin(), sums_.end()}; }

 private:
  /// How much of a fine cell lies in coarse cell `cell` and in the next, of a coarse cell's size.
  struct Share {
    std::int64_t cell = 0;
    double in_cell = 0, in_next = 0;
  };
  static Share share(std::int64_t fine_cell, std::int64_t fine, std::int64_t coarse);
  void add_line(std::int64_t row, double weight);

  Size fine_, coarse_;
  int y0_, y1_, first_row_, last_row_;
  std::size_t channels_;
  std::vector<Share> columns_;
  std::vector<double> line_, sums_;
};

}  // namespace spectrace
