// SPDX-License-Identifier: Apache-2.0
// What memory is there, asked before much of it is taken: Linux grants what it does not have, and then kills.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace spectrace {

/// Bytes that this process may still take: the least of what the machine has free or can free (swap
/// included), what is left of the control group it runs in (a job of a cluster), and its own limit of address
/// space. nullopt where the system does not tell.
std::optional<std::uint64_t> available_memory_bytes();

/// "1.50 GB": 10^9 bytes.
std::string gigabytes_text(std::uint64_t bytes);

/// Throws InputError{file, where} where `needed_bytes` are more than available: "`what` takes about 190.00
/// GB of memory, and 23.00 GB are free".
void require_memory(std::uint64_t needed_bytes, const std::string& file, const std::string& where,
                    const std::string& what);

}  // namespace spectrace
