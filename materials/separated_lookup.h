// SPDX-License-Identifier: Apache-2.0
// One vocabulary for both forms of a separated material's tables, the plain and the compact one.
#pragma once

#include <memory>
#include <variant>
#include <vector>

#include "core/spectra/sampled_spectrum.h"
#include "materials/compact_tables.h"
#include "materials/separated_tables.h"

namespace spectrace {

/// A separated material in either form.
using SeparatedSource =
    std::variant<std::shared_ptr<const SeparatedTables>, std::shared_ptr<const CompactTables>>;

/// Reads a `.sep` file of either form; throws InputError.
SeparatedSource read_separated_source(const std::filesystem::path& file);
SeparatedSource separated_source(const TensorFile& tensors);

/// The richest model it holds tables for.
SeparationModel richest_model(const SeparatedSource& source);

/// Does any light leave by the specular lobe of that model?
bool has_specular(const SeparatedTables& tables, SeparationModel model);
bool has_specular(const CompactTables& tables, SeparationModel model);

/// Has the processor fetch what the functions below will read at a point: a table's cells are rarely in the
/// caches, and other work can go on meanwhile.
template <typename Codes>
void prefetch(const Codes& rho_s, const std::vector<float>& s_diffraction, std::size_t row_size,
              const GridPoint& point) {
  // Every other cell: its neighbour in phi_d lies beside it.
  for (std::size_t i = 0; i < point.cell.size(); i += 2) __builtin_prefetch(&rho_s[point.cell[i]]);
  if (s_diffraction.empty()) return;
  for (const std::uint32_t at : point.angular) __builtin_prefetch(&s_diffraction[at * row_size]);
}
inline void prefetch(const SeparatedTables& tables, const GridPoint& point) {
  prefetch(tables.rho_s, tables.s_diffraction, tables.axis.size(), point);
}
inline void prefetch(const CompactTables& tables, const GridPoint& point) {
  prefetch(tables.rho_s.code, tables.s_diffraction, tables.rank, point);
}

template <typename Table>
Float trilinear(const Table& table, const GridPoint& point) {
  Float sum = 0;
  for (std::size_t i = 0; i < point.cell.size(); ++i) {
    sum += point.cell_weight[i] * Float(table[point.cell[i]]);
  }
  return sum;
}

/// ρ_s (cosθi + cosθo) [1/sr] at a point of the grid.
template <typename Tables>
Float specular_at(const Tables& tables, const GridPoint& point) {
  return trilinear(tables.rho_s, point);
}

/// Share of the Lambert lobe that is there, in [0, 1].
inline Float diffuse_shape_at(const SeparatedTables& tables, const GridPoint& point) {
  return tables.diffuse_shape.empty() ? Float(1) : trilinear(tables.diffuse_shape, point);
}
inline Float diffuse_shape_at(const CompactTables& tables, const GridPoint& point) {
  return tables.diffuse_shape.empty() ? Float(1) : trilinear(tables.diffuse_shape, point) / 255;
}

/// s of the model at a point, at a path's wavelengths; that of kResidual is that of kDiffraction. >= 0.
SampledSpectrum spectral_factor(const SeparatedTables& tables, SeparationModel model, const GridPoint& point,
                                const SpectralAxis::Lookup& lookup);
SampledSpectrum spectral_factor(const CompactTables& tables, SeparationModel model, const GridPoint& point,
                                const SpectralAxis::Lookup& lookup);

/// The same over the whole axis; `row` has axis.size() elements.
void spectral_row(const SeparatedTables& tables, SeparationModel model, const GridPoint& point,
                  std::vector<double>& row);
void spectral_row(const CompactTables& tables, SeparationModel model, const GridPoint& point,
                  std::vector<double>& row);

}  // namespace spectrace
