// SPDX-License-Identifier: Apache-2.0
#include "materials/residual_table.h"

#include <array>

namespace spectrace {

SampledSpectrum ResidualTable::at(const GridPoint& point, const SpectralAxis::Lookup& lookup) const {
  std::array<float, kMaxResidualRank> coefficient{};
  for (std::size_t i = 0; i < point.cell.size(); ++i) {
    const std::int8_t* const terms = &ratio[point.cell[i] * rank];
    for (std::size_t k = 0; k < rank; ++k) coefficient[k] += point.cell_weight[i] * float(terms[k]);
  }
  SampledSpectrum sum;
  for (std::size_t k = 0; k < rank; ++k) {
    sum += lookup.apply(&basis[k * axis_size]) * Float(coefficient[k] * step);
  }
  return sum;
}

}  // namespace spectrace
