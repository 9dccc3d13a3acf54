// SPDX-License-Identifier: Apache-2.0
// The number type of the light path. Fitting, film sums and metrics use double directly.
#pragma once

namespace spectrace {

#ifdef SPECTRACE_DOUBLE
using Float = double;  // validation build: how much does single precision cost?
#else
using Float = float;
#endif

/// The largest Float below 1, for random numbers in [0, 1).
inline constexpr Float kOneMinusEpsilon =
    sizeof(Float) == 4 ? Float(0x1.fffffep-1) : Float(0x1.fffffffffffffp-1);

}  // namespace spectrace
