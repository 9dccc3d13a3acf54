// SPDX-License-Identifier: Apache-2.0
// The small form of a separated material, at a chosen precision.
#pragma once

#include "materials/compact_tables.h"
#include "materials/separated_tables.h"

namespace spectrace {

/// Bits of precision: rho_s keeps a relative error of at most 2^(2^-(quality+1)) - 1, about 0.35 ·
/// 2^-quality; spectra a root mean square error, weighted by the light they colour, of at most
/// 2^-(quality+1).
inline constexpr int kMinQuality = 1, kMaxQuality = 11, kDefaultQuality = 7;

struct CompactReport {
  double rho_s_error_bound = 0;   ///< relative
  double spectral_rms_error = 0;  ///< of s_F and s_D together, relative, weighted by rho_s
  std::size_t spectral_rank = 0;
};

struct CompactResult {
  CompactTables tables;
  CompactReport report;
};

/// `quality` in [kMinQuality, kMaxQuality] (checked). Holds what `richest` and the cheaper models need, as
/// far as `tables` has it.
CompactResult compact(const SeparatedTables& tables, int quality,
                      SeparationModel richest = SeparationModel::kResidual);

}  // namespace spectrace
