// SPDX-License-Identifier: Apache-2.0
// Measured refractive indices in the files of the refractiveindex.info database.
#pragma once

#include <filesystem>

#include "core/spectra/spectrum.h"

namespace spectrace {

struct RefractiveIndex {
  Spectrum eta, k;
};

/// The first "tabulated nk" block of a database file: lines of wavelength [µm], n and k below `data: |`.
/// Throws InputError with line and column.
RefractiveIndex read_refractive_index(const std::filesystem::path& file);

}  // namespace spectrace
