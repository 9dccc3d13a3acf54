// SPDX-License-Identifier: Apache-2.0
#include "cli/output.h"

#include <system_error>

#include "core/base/error.h"

namespace spectrace::cli {

void require_folder_of(const std::filesystem::path& file) {
  const std::filesystem::path folder =
      file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
  std::error_code error;
  if (!std::filesystem::is_directory(folder, error)) {
    throw InputError(folder.string(), "", "is no folder to write to");
  }
  if (std::filesystem::is_directory(file, error)) {
    throw InputError(file.string(), "", "is a folder, not a file to write");
  }
}

}  // namespace spectrace::cli
