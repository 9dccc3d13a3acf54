// SPDX-License-Identifier: Apache-2.0
// Files: read whole, written aside and renamed.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace spectrace {

/// The whole file. Throws InputError where it cannot be opened or is larger than `max_bytes`.
std::vector<std::byte> read_file(const std::filesystem::path& file, std::size_t max_bytes = std::size_t(4)
                                                                                            << 30);

/// Runs `write` on a temporary name in the same folder (the same extension, so that image libraries choose
/// the right format), then renames it over `file`. If `write` throws or the rename fails the temporary is
/// removed, an old `file` is untouched, and the exception goes on; a failing system call throws InputError.
void write_atomically(const std::filesystem::path& file,
                      const std::function<void(const std::filesystem::path&)>& write);
void write_file_atomically(const std::filesystem::path& file, std::span<const std::byte> bytes);
void write_file_atomically(const std::filesystem::path& file, std::string_view text);

/// SHA-256 in lower-case hex (64 digits), for provenance and cache keys.
std::string sha256_hex(std::span<const std::byte> bytes);

}  // namespace spectrace
