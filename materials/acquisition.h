// SPDX-License-Identifier: Apache-2.0
// A virtual goniophotometer: measures any material of this program into the tables of the EPFL database, as
// Dupuy & Jakob 2018 do with a real one. It gives tests a truth that real measurements lack.
#pragma once

#include <string>
#include <vector>

#include "core/base/progress.h"
#include "materials/material.h"
#include "materials/measured_tables.h"

namespace spectrace {

struct AcquisitionOptions {
  int elevations = 8;  ///< incident elevations in [3, 64], the last at 90° a copy of the one before it
  double last_elevation_deg =
      85;  ///< the last measured one, in (0, 90); equal steps of its cosine lead there
  /// 1: isotropic. Otherwise the incident azimuths in [4, 64] over 360°/symmetry, both ends included.
  int azimuths = 1;
  int symmetry = 1;    ///< 1, 2 (point symmetric) or 4 (mirror symmetric about x and y); needs azimuths > 1
  int ndf_size = 128;  ///< nodes of the normal distribution over elevation, in [8, 512]
  int ndf_azimuths = 32;  ///< and over azimuth, in [4, 128]; used where azimuths > 1
  int warp_size = 128;    ///< side of the visible-normal tables, in [8, 512]
  int table_size = 32;    ///< side of the spectra tables, in [4, 256]
  std::vector<float> lambda_nm = epfl_wavelengths_nm();  ///< increasing, at least one
  std::string description = "Virtual measurement";

  /// The 195 wavelengths of the database's spectral files: 358.63 to 1001.89 nm in equal steps.
  static std::vector<float> epfl_wavelengths_nm();
  /// Empty where all is well, else what is wrong with which field.
  [[nodiscard]] std::string problem() const;
};

/// Throws InputError where the material has nothing to measure (delta lobes only, transmissive, or black) and
/// where `options.problem()`. One-sided reflection at uv = (0, 0).
MeasuredTables acquire(const Material& material, const AcquisitionOptions& options, Progress& progress);

}  // namespace spectrace
