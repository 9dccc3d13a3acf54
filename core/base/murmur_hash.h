// SPDX-License-Identifier: Apache-2.0
// MurmurHash3 by Austin Appleby, the 32-bit form: how Cryptomatte names objects. Not for keeping secrets.
#pragma once

#include <cstdint>
#include <string_view>

namespace spectrace {

[[nodiscard]] std::uint32_t murmur_hash3_32(std::string_view bytes, std::uint32_t seed = 0);

}  // namespace spectrace
