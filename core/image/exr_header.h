// SPDX-License-Identifier: Apache-2.0
// The attributes of an EXR header, looked over before a library believes them. Internal to core/image.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace spectrace {

/// Attributes announce their sizes, and the library allocates before it reads. Throws InputError, naming
/// `file` and byte, where one announces more than the file can hold, pixels among it, or another size than
/// its type has: the library would go on reading elsewhere than the next attribute. `bytes` may be the
/// beginning of a file of `file_size`. Layout: "OpenEXR File Layout", openexr.com, sections "Header",
/// "Attribute Layout" and "Predefined Attribute Types".
void check_exr_attributes(std::span<const std::byte> bytes, std::uint64_t file_size, const std::string& file);

}  // namespace spectrace
