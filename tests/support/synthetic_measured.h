// SPDX-License-Identifier: Apache-2.0
// Small measured BRDFs from formulae: every layout the reader knows, at sizes that tests can loop over.
#pragma once

#include "core/math/math.h"
#include "materials/measured_tables.h"

namespace spectrace::test {

struct SyntheticMeasured {
  bool isotropic = true;
  /// 1, 2 or 4: the symmetry the material has, if anisotropic.
  int symmetry = 1;
  /// Stored phi_i span 2π / this; any of 1, 2, 4 that divides `symmetry`.
  int stored_reduction = 1;
  double first_phi_i = -kPi64;
  bool rgb = false;
  bool jacobian = true;
};

/// 5 elevations to 90 degrees, the last a copy of the one before; 3, 5 or 9 azimuths, 45 degrees apart; a
/// 17x17 warp and 9x9 spectra at 7 wavelengths. Has cells and directions of value 0, and a small sigma. The
/// grids' sizes are odd so that all symmetries map nodes to nodes: tables of one material with different
/// `stored_reduction` are the same BRDF.
MeasuredTables make_measured(const SyntheticMeasured& options);

}  // namespace spectrace::test
