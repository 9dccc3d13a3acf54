// SPDX-License-Identifier: Apache-2.0
// A separated material made small (ADR 0007): rho_s as logarithmic codes, spectra as products of low rank.
// The renderer evaluates this form as it is.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "materials/half_difference_grid.h"
#include "materials/residual_table.h"
#include "materials/spectral_axis.h"
#include "materials/tensor_file.h"

namespace spectrace {

/// Values >= 0 as codes: 0 stands for 0, code c for max · 2^(-(last - c) · octaves_per_code).
struct LogCodes {
  std::vector<std::uint16_t> code;
  std::vector<float> level;  ///< [code] what each stands for; level[0] = 0

  /// Every value within a factor 2^(±octaves_per_code / 2) of its own; below 2^-24 of the largest it becomes
  /// 0.
  static LogCodes encode(const std::vector<float>& values, float octaves_per_code);
  static LogCodes from_codes(std::vector<std::uint16_t> code, float max, float octaves_per_code);
  [[nodiscard]] float operator[](std::size_t i) const { return level[code[i]]; }
};

/// As SeparatedTables, which see.
struct CompactTables {
  HalfDifferenceGrid grid;
  SpectralAxis axis;
  float octaves_per_code = 0;  ///< precision of rho_s: its relative error is at most 2^(octaves/2) - 1
  LogCodes rho_s;
  std::vector<float> c_d;    ///< [axis]
  std::vector<float> s_sun;  ///< [axis]
  /// s_F and s_D = weights · basis, clamped at 0.
  std::size_t rank = 0;
  std::vector<float> basis;                 ///< [rank][axis]
  std::vector<float> s_fresnel;             ///< [theta_d][rank]
  std::vector<float> s_diffraction;         ///< [theta_h][theta_d][rank]
  std::vector<std::uint8_t> diffuse_shape;  ///< [theta_h][theta_d][phi_d] in units of 1/255, or empty
  ResidualTable residual;
  std::vector<float> analytic;  ///< [4][axis] as SeparatedTables::analytic, or empty
  std::string source_name, source_sha256, report_json;
};

/// More terms than these no measured material needs (docs/separation.md).
inline constexpr std::size_t kMaxSpectralRank = 24;

/// Throws InputError naming the field.
CompactTables compact_from_tensors(const TensorFile& tensors);
TensorFile compact_to_tensors(const CompactTables& tables);
/// A file of this form, told by its field "format".
bool is_compact(const TensorFile& tensors);

}  // namespace spectrace
