// SPDX-License-Identifier: Apache-2.0
#include "core/image/area_means.h"

#include <algorithm>

#include "core/base/error.h"

namespace spectrace {

AreaMeans::AreaMeans(Size fine, Size coarse, int y0, int y1, std::size_t channels)
    : fine_(fine), coarse_(coarse), y0_(y0), y1_(y1), channels_(channels) {
  SPECTRACE_CHECK(coarse.width >= 1 && coarse.width <= fine.width && coarse.height >= 1 &&
                  coarse.height <= fine.height && 0 <= y0 && y0 < y1 && y1 <= coarse.height);
  const std::int64_t n = fine.height, m = coarse.height;
  first_row_ = int(y0 * n / m);
  last_row_ = int((y1 * n + m - 1) / m);
  for (int x = 0; x < fine.width; ++x) columns_.push_back(share(x, fine.width, coarse.width));
  line_.resize(std::size_t(coarse.width) * channels);
  sums_.resize(line_.size() * std::size_t(y1 - y0));
}

/// In units of 1 / (fine · coarse) of the side all borders are integers.
AreaMeans::Share AreaMeans::share(std::int64_t fine_cell, std::int64_t fine, std::int64_t coarse) {
  const std::int64_t begin = fine_cell * coarse, end = begin + coarse;
  const std::int64_t cell = begin / fine, border = (cell + 1) * fine;
  return {cell, double(std::min(end, border) - begin) / double(fine),
          double(std::max<std::int64_t>(end - border, 0)) / double(fine)};
}

void AreaMeans::add(int row, const float* texels) {
  std::fill(line_.begin(), line_.end(), 0.0);
  for (const Share& column : columns_) {
    double* const here = &line_[std::size_t(column.cell) * channels_];
    for (std::size_t c = 0; c < channels_; ++c) here[c] += column.in_cell * double(texels[c]);
    if (column.in_next > 0) {
      for (std::size_t c = 0; c < channels_; ++c) here[channels_ + c] += column.in_next * double(texels[c]);
    }
    texels += channels_;
  }
  const Share rows = share(row, fine_.height, coarse_.height);
  add_line(rows.cell, rows.in_cell);
  if (rows.in_next > 0) add_line(rows.cell + 1, rows.in_next);
}

void AreaMeans::add_line(std::int64_t row, double weight) {
  if (row < y0_ || row >= y1_) return;
  double* const sums = &sums_[std::size_t(row - y0_) * line_.size()];
  for (std::size_t i = 0; i < line_.size(); ++i) sums[i] += weight * line_[i];
}

}  // namespace spectrace
