// SPDX-License-Identifier: Apache-2.0
// What one sample adds to the row of its pixel beside its layers.
#pragma once

#include <array>
#include <cstddef>

#include "core/spectra/lane_to_xyz.h"
#include "renderer/pixel_sums.h"

namespace spectrace {

/// A row that holds everything.
using FullRow = std::array<double, slots::kCount>;

/// The squares of R, G, B of a moment layer, and where the sample `is_in_b` its X, Y, Z.
void add_moment(std::size_t layer, const PathXyz& xyz, bool is_in_b, FullRow& row);
/// The numbers and their squares.
void add_features(const FeatureNumbers& features, FullRow& row);

}  // namespace spectrace
