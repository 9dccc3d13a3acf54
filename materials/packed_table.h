// SPDX-License-Identifier: Apache-2.0
// Integer tables on the half-difference grid, packed without loss: predicted from their neighbours, then
// compressed by Zstandard.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "materials/half_difference_grid.h"
#include "materials/tensor_file.h"

namespace spectrace {

/// `planes` tables one after another, each [rows][columns]; values wrap around at the type's range.
struct PlaneShape {
  std::size_t planes = 1, rows = 1, columns = 1;
  [[nodiscard]] std::size_t size() const { return planes * rows * columns; }
};

/// A tensor of bytes: prediction errors of `values`, compressed.
Tensor pack(std::string name, std::span<const std::uint8_t> values, const PlaneShape& shape);
Tensor pack(std::string name, std::span<const std::uint16_t> values, const PlaneShape& shape);
/// The inverse; nullopt where the tensor does not hold exactly such a table. Never allocates more than that
/// table.
std::optional<std::vector<std::uint8_t>> unpack_u8(const Tensor& tensor, const PlaneShape& shape);
std::optional<std::vector<std::uint16_t>> unpack_u16(const Tensor& tensor, const PlaneShape& shape);

}  // namespace spectrace
