// SPDX-License-Identifier: Apache-2.0
// Step 3 (sec. 4.4): the spectral distributions of the lobes, eqs. 18-20.
#pragma once

#include <vector>

#include "core/base/progress.h"
#include "materials/measured_brdf.h"
#include "separation/cell_table.h"
#include "separation/separate.h"
#include "separation/split.h"

namespace spectrace {

struct SpectralFit {
  std::vector<float> s_d;            ///< [axis]; 0 where there is no diffuse lobe
  std::vector<float> s_sun;          ///< [axis], eq. 18
  std::vector<float> s_fresnel;      ///< [theta_d][axis], eq. 19
  std::vector<float> s_diffraction;  ///< [theta_h][theta_d][axis], eq. 20
  /// [axis] root mean square of ln(ρ w + ε) - ln((s_d ρ_d + s ρ_s) w + ε): one measure for the three models.
  std::vector<double> rms_sun, rms_fresnel, rms_diffraction;
  int unfinished = 0;  ///< unknowns of eqs. 18-20 whose solver the iterations' limit has cut short
};

/// Solves the three problems one after the other, a block of wavelengths at a time. `s_d`: [axis] where the
/// diffuse colour is known already, else empty. Runs in parallel; the
/// same for any number of threads.
SpectralFit fit_spectra(const MeasuredBrdf& measured, const CellTable& table, const SplitResult& split,
                        const std::vector<float>& s_d, const SeparationOptions& options, Progress& progress);

}  // namespace spectrace
