// SPDX-License-Identifier: Apache-2.0
// Metals by their chemical symbol.
#pragma once

#include <initializer_list>
#include <string_view>

#include "materials/refractive_index.h"

namespace spectrace {

/// Measured on opaque films or polished metal; where from: metals.cpp. Outside 200 to 2000 nm the end values
/// hold.
inline const std::initializer_list<std::string_view> kMetalNames{"Ag", "Al", "Au", "Cr", "Cu", "Ti"};
/// `name` is one of kMetalNames.
[[nodiscard]] RefractiveIndex named_metal(std::string_view name);

}  // namespace spectrace
