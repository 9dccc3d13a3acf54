// SPDX-License-Identifier: Apache-2.0
// The paper's table X on its half-difference grid, without ever holding it: which table rows of the
// measurement make up each cell, and the achromatic mean (sec. 4.2).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "materials/measured_brdf.h"
#include "materials/separated_tables.h"
#include "separation/separate.h"

namespace spectrace {

/// What the grid's cells hold, counted. The first three sum to the rest of `cells`.
struct CellCounts {
  std::size_t cells = 0;
  std::size_t below_horizon = 0;
  std::size_t measured = 0;  ///< enter the fits
  /// Above the horizon, but beyond the last measured elevation in both orders; or in one, where the other
  /// lies too near the horizon to tell f.
  std::size_t extrapolated = 0;
  std::size_t invalid = 0;  ///< the same of what the file marks invalid
};

/// Cells that were measured ("fitted" cells), grouped by (theta_h, theta_d), with what the fits need of each.
/// With f̂ the reciprocal BRDF (docs/separation.md, "Table X") and w the cosine weight of eq. 10:
struct CellTable {
  HalfDifferenceGrid grid;
  CellCounts counts;

  /// [theta_h][theta_d][phi_d]: mean over the axis of q = f̂ (cosθi + cosθo) [1/sr]; negative where a
  /// direction of the cell lies below the horizon.
  std::vector<float> mean_q;

  std::vector<std::uint32_t> begin;  ///< [theta_h · theta_d + 1]: the fitted cells of each group
  std::vector<std::uint32_t> cell;   ///< index into the grid
  std::vector<float> cos_i, cos_o;
  std::vector<float> weight;  ///< w
  std::vector<float> mean;    ///< mean over the axis of f̂

  std::vector<std::uint32_t> node_begin;  ///< [fitted + 1]
  std::vector<std::uint32_t> node_row;    ///< rows of the measurement
  std::vector<float> node_weight;         ///< Σ weight · spectrum(row) = f̂ w, at every wavelength

  [[nodiscard]] std::size_t fitted() const { return cell.size(); }
  [[nodiscard]] double cos_sum(std::size_t i) const { return double(cos_i[i]) + double(cos_o[i]); }
};

/// w of eqs. 9 and 10.
double cosine_weight(double cos_i, double cos_o, const SeparationOptions& options);

/// Runs in parallel; the same for any number of threads.
CellTable build_cell_table(const MeasuredBrdf& measured, const SeparationOptions& options);

/// The share of dωh dωd, in which dωi dωo = 4 cosθd dωh dωd, that one node at (theta_h, theta_d) stands for,
/// times cosθd; without the steps of theta_d and phi_d, which are the same for all.
[[nodiscard]] double node_measure(const HalfDifferenceGrid& grid, std::size_t h, std::size_t d);

}  // namespace spectrace
