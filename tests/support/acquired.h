// SPDX-License-Identifier: Apache-2.0
// Measurements of the project's own materials, small enough for tests to loop over.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "materials/acquisition.h"
#include "materials/material.h"
#include "materials/measured_brdf.h"

namespace spectrace::test {

inline const std::vector<float> kAcquiredWavelengthsNm{400, 450, 500, 550, 600, 650, 700};

/// scenes/materials/NAME.json as the virtual goniophotometer sees it.
inline MeasuredTables acquired_tables(const std::string& name,
                                      std::vector<float> lambda_nm = kAcquiredWavelengthsNm) {
  const Material material = build_material(
      load_material(std::filesystem::path(SPECTRACE_SOURCE_DIR) / "scenes/materials" / (name + ".json")));
  AcquisitionOptions options;
  options.lambda_nm = std::move(lambda_nm);
  SilentProgress progress;
  return acquire(material, options, progress);
}
inline MeasuredBrdf acquired(const std::string& name, std::vector<float> lambda_nm = kAcquiredWavelengthsNm) {
  return MeasuredBrdf(acquired_tables(name, std::move(lambda_nm)));
}

/// "glossy", up to 0.3 brighter the farther into the measurement's elevations light is reflected to.
inline MeasuredBrdf not_reciprocal() {
  const MeasuredBrdf glossy = acquired("glossy");
  MeasuredTables tables = glossy.tables();
  const std::size_t n = tables.axis.size(),
                    rows = tables.slices() * std::size_t(tables.table_size) * std::size_t(tables.table_size);
  tables.spectra.resize(rows * n);  // [slice][axis][row of the table]
  const std::size_t per_slice = rows / tables.slices();
  for (std::size_t r = 0; r < rows; ++r) {
    const double tilt = 1 + 0.3 * double(r / per_slice) / double(tables.slices());
    for (std::size_t k = 0; k < n; ++k) {
      tables.spectra[(r / per_slice * n + k) * per_slice + r % per_slice] =
          static_cast<float>(tilt * double(glossy.spectrum(static_cast<std::uint32_t>(r))[k]));
    }
  }
  return MeasuredBrdf(std::move(tables));
}

}  // namespace spectrace::test
