// SPDX-License-Identifier: Apache-2.0
#include "renderer/sample_sums.h"

#include "core/base/wide.h"
#include "core/spectra/color.h"

namespace spectrace {
namespace {

/// What X, Y and Z add to (R, G, B, 0), side by side as registers hold them.
using Columns = std::array<std::array<double, slots::kFour>, 3>;

const Columns kXyzToRgb = [] {
  Columns columns{};
  for (std::size_t i = 0; i < columns.size(); ++i) {
    Xyz unit{};
    unit[i] = 1;
    const Rgb rgb = xyz_to_rgb(unit);
    for (std::size_t c = 0; c < rgb.size(); ++c) columns[i][c] = rgb[c];
  }
  return columns;
}();

SPECTRACE_WIDE void add_rgb_squares(const Columns& columns, const double* xyz, double* squares) {
  const double x = xyz[0], y = xyz[1], z = xyz[2];
  for (std::size_t c = 0; c < slots::kFour; ++c) {
    const double rgb = columns[0][c] * x + columns[1][c] * y + columns[2][c] * z;
    squares[c] += rgb * rgb;
  }
}

SPECTRACE_WIDE void add_features(const double* features, double* row) {
  for (std::size_t i = 0; i < kFeatureNumbers; ++i) {
    const double x = features[i];
    row[slots::kFeatures + i] += x;
    row[slots::kFeatureSquares + i] += x * x;
  }
}

}  // namespace

void add_moment(std::size_t layer, const PathXyz& xyz, bool is_in_b, FullRow& row) {
  add_rgb_squares(kXyzToRgb, xyz.data(), &row[slots::rgb_squares(layer)]);
  if (!is_in_b) return;
  for (std::size_t c = 0; c < xyz.size(); ++c) row[slots::b_xyz(layer) + c] += xyz[c];
}

void add_features(const FeatureNumbers& features, FullRow& row) { add_features(features.data(), row.data()); }

}  // namespace spectrace
