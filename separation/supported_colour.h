// SPDX-License-Identifier: Apache-2.0
// How bright a Lambert lobe may be at each wavelength before the measurement refutes it.
#pragma once

#include "separation/spectral_sums.h"

namespace spectrace {

/// Lowers each of the first `count` colours problem.s_d to the largest at which the exact Lambert lobe
/// reflects, under uniform light, at most kSupportedExcess of the material's light too much. True where any
/// was lowered.
bool support_colour(StripProblem& problem, int count);

}  // namespace spectrace
