// SPDX-License-Identifier: Apache-2.0
// How different two colours look.
#pragma once

#include "core/spectra/spectrum.h"

namespace spectrace {

/// CIEDE2000 of two CIELAB colours, kL = kC = kH = 1: about 1 where a difference is just seen. CIE 142; the
/// formulas, and the cases of undefined hue, as in Sharma, Wu and Dalal, "The CIEDE2000 color-difference
/// formula" (2005), eqs. 2-22.
double ciede2000(const Xyz& lab1, const Xyz& lab2);

}  // namespace spectrace
