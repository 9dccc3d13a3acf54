// SPDX-License-Identifier: Apache-2.0
#include "materials/residual_file.h"

#include <array>

namespace spectrace {
namespace {

/// [cell][rank] and back from [rank][cell]: planes are what neighbours predict.
std::vector<std::uint8_t> to_planes(const std::vector<std::int8_t>& ratio, std::size_t rank) {
  const std::size_t cells = ratio.size() / rank;
  std::vector<std::uint8_t> planes(ratio.size());
  for (std::size_t c = 0; c < cells; ++c) {
    for (std::size_t k = 0; k < rank; ++k) {
      planes[k * cells + c] = static_cast<std::uint8_t>(ratio[c * rank + k]);
    }
  }
  return planes;
}
std::vector<std::int8_t> from_planes(const std::vector<std::uint8_t>& planes, std::size_t rank) {
  const std::size_t cells = planes.size() / rank;
  std::vector<std::int8_t> ratio(planes.size());
  for (std::size_t c = 0; c < cells; ++c) {
    for (std::size_t k = 0; k < rank; ++k) {
      ratio[c * rank + k] = static_cast<std::int8_t>(planes[k * cells + c]);
    }
  }
  return ratio;
}

}  // namespace

PlaneShape cells_of(const HalfDifferenceGrid& grid, std::size_t tables) {
  return {.planes = tables * std::size_t(grid.n_theta_h),
          .rows = std::size_t(grid.n_theta_d),
          .columns = std::size_t(grid.n_phi_d)};
}

ResidualTable read_residual(const TensorReader& reader, const HalfDifferenceGrid& grid,
                            std::size_t axis_size) {
  ResidualTable residual;
  residual.axis_size = axis_size;
  residual.rank = reader.rank("residual_basis", kMaxResidualRank);
  residual.basis = reader.finite("residual_basis", std::array{residual.rank, axis_size});
  residual.step = reader.non_negative("residual_step", std::array<std::size_t, 1>{1})[0];
  const auto terms = [&](const char* field) {
    return from_planes(reader.bytes(field, cells_of(grid, residual.rank)), residual.rank);
  };
  residual.ratio = terms("residual_ratio");
  if (reader.has("residual_odd")) residual.odd = terms("residual_odd");
  return residual;
}

void add_residual(const ResidualTable& residual, const HalfDifferenceGrid& grid, TensorFile& file) {
  file.add(Tensor::from_floats("residual_basis", {residual.rank, residual.axis_size}, residual.basis));
  file.add(Tensor::from_floats("residual_step", {1}, std::array{residual.step}));
  const auto add = [&](const char* field, const std::vector<std::int8_t>& terms) {
    const std::vector<std::uint8_t> planes = to_planes(terms, residual.rank);
    file.add(pack(field, std::span<const std::uint8_t>(planes), cells_of(grid, residual.rank)));
  };
  add("residual_ratio", residual.ratio);
  if (!residual.odd.empty()) add("residual_odd", residual.odd);
}

}  // namespace spectrace
