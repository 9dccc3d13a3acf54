// SPDX-License-Identifier: Apache-2.0
// Eqs. 7-15 over many cells at once: the sum of squares of Lambert + GGX, and what Gauss-Newton needs of it.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "separation/cell_table.h"
#include "separation/separate.h"

namespace spectrace {

/// What eq. 9 takes of each cell, side by side.
struct LobeCells {
  std::vector<float> cos_i, cos_o, weight;
  std::vector<float> sin2_h;    ///< sin² θh: cos θh near 1 would lose it
  std::vector<float> schlick;   ///< (1 - cos θd)^5, eq. 13
  std::vector<float> log_data;  ///< ln(f̂ w + ε)

  [[nodiscard]] std::size_t size() const { return weight.size(); }
};

/// Every `stride`th fitted cell; `log_data` of the achromatic mean.
LobeCells lobe_cells(const CellTable& table, double epsilon, std::size_t stride);

/// The parameters as the solver sees them: alpha_d, the factors p and q of the lobe, ln a. With F of eq. 13,
/// rho_0 F = p + q (1 - cosθd)^5. Three of the four are linear, and the bounds F_0 in [0, 1] and rho_0 >= 0
/// are p >= 0 and q >= 0; the logarithm makes steps in roughness relative.
inline constexpr int kFitParameters = 4;
using LobeVector = std::array<double, kFitParameters>;
inline constexpr double kLeastAlpha = 1e-3;  // of AnalyticParameters
LobeVector to_lobe(const AnalyticFit& fit);
AnalyticFit from_lobe(const LobeVector& x);

/// The upper triangle of [J r]ᵀ[J r] over LobeVector: all that least squares needs, whatever the number of
/// residuals.
inline constexpr std::size_t kAugmented = kFitParameters + 1;
using Gram = std::array<std::array<double, kAugmented>, kAugmented>;

/// Of all of `cells` on this thread, in parallel, or of a part; the same bits in any case for the same cells.
Gram lobe_gram(const LobeCells& cells, double epsilon, const LobeVector& x);
Gram lobe_gram_in_parallel(const LobeCells& cells, double epsilon, const LobeVector& x);

}  // namespace spectrace
