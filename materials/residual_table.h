// SPDX-License-Identifier: Apache-2.0
// What the diffraction model leaves of the table X, as a few signed terms in direction x wavelength (ADR
// 0007).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/spectra/sampled_spectrum.h"
#include "materials/half_difference_grid.h"
#include "materials/spectral_axis.h"

namespace spectrace {

/// R(cell, λ) = M(cell) · step · Σ_k (ratio[cell][k] ± 2 cosθo / (cosθi + cosθo) · odd[cell][k]) ·
/// basis[k](λ), where M is the mean of the diffraction model over the axis: relative to the material's own
/// brightness, a byte is precise enough everywhere. `odd` changes its sign where the directions are
/// exchanged: measurements are not reciprocal. Its factor keeps it bounded: at either horizon what it adds to
/// f cosθi vanishes.
struct ResidualTable {
  std::vector<float> basis;        ///< [rank][axis]
  std::vector<std::int8_t> ratio;  ///< [theta_h][theta_d][phi_d][rank]
  std::vector<std::int8_t> odd{};  ///< likewise, or empty: then the residual is reciprocal
  float step = 0;                  ///< of `ratio`, > 0
  std::size_t rank = 0;            ///< 0: no residual was fitted
  std::size_t axis_size = 0;

  [[nodiscard]] bool is_empty() const { return rank == 0; }
  /// R / M at a point of the grid, signed; `cos_share_o` = cosθo / (cosθi + cosθo).
  [[nodiscard]] SampledSpectrum at(const GridPoint& point, Float cos_share_o,
                                   const SpectralAxis::Lookup& lookup) const;
};

/// More terms than this never paid for themselves (docs/separation.md).
inline constexpr std::size_t kMaxResidualRank = 6;

}  // namespace spectrace
