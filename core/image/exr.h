// SPDX-License-Identifier: Apache-2.0
// EXR from memory: behind read_image() and read_metadata(). Internal to core/image.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

#include "core/image/image.h"

namespace spectrace {

[[nodiscard]] bool is_exr(std::span<const std::byte> bytes);
/// Both throw InputError naming `file`.
[[nodiscard]] Image decode_exr(std::span<const std::byte> bytes, const std::string& file,
                               std::size_t max_pixels);
[[nodiscard]] Metadata decode_exr_metadata(std::span<const std::byte> bytes, const std::string& file);
/// Refuses an EXR file whose header announces more than the file can hold, before a library believes it;
/// other files pass.
void check_exr_header(const std::filesystem::path& file);

}  // namespace spectrace
