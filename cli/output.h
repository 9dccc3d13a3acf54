// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace spectrace::cli {

/// Throws InputError where there is no folder to write `file` to: to be asked before the work, not after it.
void require_folder_of(const std::filesystem::path& file);

}  // namespace spectrace::cli
