// SPDX-License-Identifier: Apache-2.0
// A virtual goniophotometer: measures any BRDF into the tables of the EPFL database, as Dupuy & Jakob 2018 do
// with a real one. From a material of this program it gives tests a truth that real measurements lack; from
// another instrument's data it gives the one layout that all the rest of the program reads.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "materials/material.h"
#include "materials/measured_tables.h"

namespace spectrace {

/// A BRDF to be measured.
class BrdfSource {
 public:
  BrdfSource() = default;
  BrdfSource(const BrdfSource&) = delete;
  BrdfSource& operator=(const BrdfSource&) = delete;
  virtual ~BrdfSource() = default;
  [[nodiscard]] virtual const SpectralAxis& axis() const = 0;
  /// Writes f cosθi [1/sr] at every place of the axis, >= 0 and finite; both directions stand above the
  /// horizon. Returns whether that is known, and not merely filled in.
  virtual bool read(Vec3 wo, Vec3 wi, std::span<float> value_cos) const = 0;
};

struct AcquisitionOptions {
  int elevations = 8;  ///< incident elevations in [3, 64], the last at 90° a copy of the one before it
  double last_elevation_deg =
      85;  ///< the last measured one, in (0, 90); equal steps of its cosine lead there
  /// 1: isotropic. Otherwise the incident azimuths in [4, 64] over 360°/symmetry, both ends included.
  int azimuths = 1;
  int symmetry = 1;    ///< 1, 2 (point symmetric) or 4 (mirror symmetric about x and y); needs azimuths > 1
  int ndf_size = 128;  ///< nodes of the normal distribution over elevation, in [8, 256]
  int ndf_azimuths = 32;  ///< and over azimuth, in [5, 65]; used where azimuths > 1
  int warp_size = 128;    ///< side of the visible-normal tables, in [8, 512]
  int table_size = 32;    ///< side of the spectra tables, in [4, 256]
  /// Of a material; increasing, at least one. Other sources have an axis of their own.
  std::vector<float> lambda_nm = epfl_wavelengths_nm();
  std::string description = "Virtual measurement";

  /// The 195 wavelengths of the database's spectral files: 358.63 to 1001.89 nm in equal steps.
  static std::vector<float> epfl_wavelengths_nm();
  /// Empty where all is well, else what is wrong with which field.
  [[nodiscard]] std::string problem() const;
};

/// Throws InputError where the material has nothing to measure (delta lobes only, transmissive, or black) and
/// where `options.problem()`. One-sided reflection at uv = (0, 0).
/// A cell of the result is `valid` where the source knew its value.
MeasuredTables acquire(const BrdfSource& source, const AcquisitionOptions& options, Progress& progress);
MeasuredTables acquire(const Material& material, const AcquisitionOptions& options, Progress& progress);

}  // namespace spectrace
