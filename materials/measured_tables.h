// SPDX-License-Identifier: Apache-2.0
// A measured BRDF as its file holds it (Dupuy & Jakob 2018), validated; reader and writer.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "materials/spectral_axis.h"
#include "materials/tensor_file.h"

namespace spectrace {

/// Where tables come from that were not measured in this layout (materials/measured_file.cpp).
struct MeasuredSource {
  std::string format = "EPFL tensor file";  ///< or "Cornell text", "MERL binary"
  std::size_t samples = 0;                  ///< what the other file holds; 0 for this layout
  std::size_t invalid_samples = 0;          ///< of them marked invalid, or negative
  std::size_t filled_cells = 0;  ///< cells above the horizon whose value no sample is near: not `valid`
};

/// The fields of an EPFL `.bsdf`. "Incident" is the file's word for the direction its slices are indexed by;
/// in this program that is wo (docs/conventions.md).
struct MeasuredTables {
  std::string file_name;  ///< for messages
  std::string description;
  std::vector<float> phi_i;           ///< [rad], increasing; one or two entries where isotropic
  std::vector<float> theta_i;         ///< [rad], increasing in [0, π/2 + 1e-4]
  int ndf_width = 0, ndf_height = 0;  ///< [height: phi][width: theta]
  std::vector<float> ndf, sigma;      ///< [ndf_height][ndf_width]
  int warp_size = 0;
  std::vector<float> vndf;  ///< [phi_i][theta_i][warp_size][warp_size]
  int table_size = 0;
  std::vector<float> luminance;  ///< [phi_i][theta_i][table_size][table_size]
  SpectralAxis axis;
  std::vector<float> spectra;  ///< [phi_i][theta_i][axis][table_size][table_size], >= 0
  /// 1 where measured, else 0: [phi_i][theta_i][table_size][table_size]; empty where the file has none.
  std::vector<unsigned char> valid;
  /// The file's flag: `spectra` are to be multiplied by ndf / (4 sigma), the Jacobian of the visible-normal
  /// warp, to give f·cos; without it they are f·cos.
  bool jacobian = true;

  MeasuredSource source;

  /// What validation changed or found.
  std::size_t negative_values = 0;  ///< of `spectra`, clamped to 0
  float most_negative = 0;
  std::size_t negative_luminances = 0;  ///< of `luminance`, clamped to 0
  bool valid_was_inverted = false;      ///< the file marks what was *not* measured (docs/file-formats.md)

  [[nodiscard]] bool is_isotropic() const { return phi_i.size() <= 2; }
  /// The stored phi_i span 2π / reduction: 1 (isotropic too), 2 or 4.
  [[nodiscard]] int symmetry_reduction() const;
  /// The last elevation [rad] that was measured: a final slice bit-equal to the one before it is a copy
  /// (hard case H1).
  [[nodiscard]] float last_measured_theta_i() const;
  [[nodiscard]] std::size_t slices() const { return phi_i.size() * theta_i.size(); }
};

/// Any of the formats of MeasuredSource, told apart by content; all but the EPFL layout are converted to it.
/// Throws InputError naming file and place.
MeasuredTables read_measured(const std::filesystem::path& file);
MeasuredTables measured_from_bytes(std::span<const std::byte> bytes, const std::string& file_name);
/// Throws InputError naming file and field: missing, wrong type or shape, not increasing, non-finite or
/// negative where that has no meaning, grids below 2x2, phi_i ranges that are no whole, half or quarter turn.
MeasuredTables measured_from_tensors(const TensorFile& tensors);
/// The EPFL layout, readable by the database's own tools.
TensorFile measured_to_tensors(const MeasuredTables& tables);

}  // namespace spectrace
