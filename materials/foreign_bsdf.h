// SPDX-License-Identifier: Apache-2.0
// Other programs also call their files ".bsdf": recognised, so that the refusal can say what was given.
#pragma once

#include <string_view>

namespace spectrace {

/// "a Zemax tabular BSDF text file" and the like, from the first bytes of a file; empty where unknown.
[[nodiscard]] std::string_view foreign_bsdf(std::string_view bytes);

}  // namespace spectrace
