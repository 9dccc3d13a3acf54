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

/// ρ_s (cosθi + cosθo) [1/sr] at a point of the grid.
Float specular_at(const SeparatedTables& tables, const GridPoint& point);
Float specular_at(const CompactTables& tables, const GridPoint& point);

/// Share of the Lambert lobe that is there, in [0, 1].
Float diffuse_shape_at(const SeparatedTables& tables, const GridPoint& point);
Float diffuse_shape_at(const CompactTables& tables, const GridPoint& point);

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
