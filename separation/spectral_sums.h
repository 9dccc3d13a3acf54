// SPDX-License-Identifier: Apache-2.0
// The sums over cells that the fits of step 3 take, for one strip of wavelengths.
#pragma once

#include <array>
#include <cstddef>

#include "separation/cell_table.h"
#include "separation/log_block.h"
#include "separation/log_root.h"

namespace spectrace {

/// What one strip's fits compare: exp(log_data) with s_d · diffuse + s · specular + ε at every cell.
struct StripProblem {
  const CellTable& table;
  const float* diffuse;   ///< [fitted]
  const float* specular;  ///< [fitted]
  const float* log_data;  ///< [fitted][kStrip]
  Strip s_d{};
  float epsilon = 0;
};

/// Cells `first`, `first + stride`, ... below `end`.
struct CellRange {
  std::size_t first = 0, end = 0, stride = 1;
};
/// Every `stride`th fitted cell that lies in one (theta_h, theta_d).
CellRange cells_of_group(const CellTable& table, std::size_t group, std::size_t stride);

/// At specular colour `s`. Single precision: for a few hundred cells at a time.
LogRootSums<float> root_sums(const StripProblem& problem, const CellRange& cells, const Strip& s);

/// eq. 20 over `cells`: the specular colour from the start `towards`.
struct GroupSolution {
  Strip s{};
  int unfinished = 0;  ///< wavelengths that the iterations' limit has cut short
};
GroupSolution solve_group(const StripProblem& problem, const CellRange& cells, const Strip& towards,
                          int count, float prior, const Strip& highest);

/// Σ r² over `cells` for each of three specular colours.
std::array<Strip, 3> squares(const StripProblem& problem, const CellRange& cells,
                             const std::array<Strip, 3>& s);

/// Of eq. 18 with r = log_data - ln(model), u = ∂model/∂s over the model: Σ of what the names say.
struct TwoLobeTerms {
  Strip rr{}, r_d{}, r_s{}, dd{}, ds{}, ss{}, r_dd{}, r_ds{}, r_ss{};
};
TwoLobeTerms two_lobe_terms(const StripProblem& problem, const CellRange& cells, const Strip& s_d,
                            const Strip& s_s);

}  // namespace spectrace
