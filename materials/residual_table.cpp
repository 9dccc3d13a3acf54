// SPDX-License-Identifier: Apache-2.0
#include "materials/residual_table.h"

#include <array>

namespace spectrace {

SampledSpectrum ResidualTable::at(const GridPoint& point, Float cos_share_o,
                                  const SpectralAxis::Lookup& lookup) const {
  std::array<float, kMaxResidualRank> coefficient{};
  const auto add = [&](const std::vector<std::int8_t>& terms, std::size_t i, float weight) {
    const std::int8_t* const term = &terms[point.cell[i] * rank];
    for (std::size_t k = 0; k < rank; ++k) coefficient[k] += weight * float(term[k]);
  };
  for (std::size_t i = 0; i < point.cell.size(); ++i) add(ratio, i, point.cell_weight[i]);
  if (!odd.empty()) {
    const auto factor = static_cast<float>(2 * cos_share_o);
    for (std::size_t i = 0; i < point.cell.size(); ++i) {
      add(odd, i, factor * point.odd_sign[i % 2] * point.cell_weight[i]);
    }
  }
  SampledSpectrum sum;
  for (std::size_t k = 0; k < rank; ++k) {
    sum += lookup.apply(&basis[k * axis_size]) * Float(coefficient[k] * step);
  }
  return sum;
}

}  // namespace spectrace
