// SPDX-License-Identifier: Apache-2.0
// The residual's fields in a `.sep` file, the same in both of its forms.
#pragma once

#include <array>
#include <string_view>

#include "materials/packed_table.h"
#include "materials/residual_table.h"
#include "materials/tensor_reader.h"

namespace spectrace {

/// All that read_residual() asks for.
inline constexpr std::array<std::string_view, 4> kResidualFields{"residual_basis", "residual_step",
                                                                 "residual_ratio", "residual_odd"};

/// The grid's cells as planes of [theta_d][phi_d]: what materials/packed_table.h predicts along.
PlaneShape cells_of(const HalfDifferenceGrid& grid, std::size_t tables = 1);

/// Throws InputError naming the field.
ResidualTable read_residual(const TensorReader& reader, const HalfDifferenceGrid& grid,
                            std::size_t axis_size);
void add_residual(const ResidualTable& residual, const HalfDifferenceGrid& grid, TensorFile& file);

}  // namespace spectrace
