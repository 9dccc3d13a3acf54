// SPDX-License-Identifier: Apache-2.0
// Where the shared measurements are; tests that need them skip, by name, where they are absent.
#pragma once

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

namespace spectrace::test {

/// $SPECTRACE_DATA, default ../shared/data from the project root.
inline std::filesystem::path data_folder() {
  const char* folder = std::getenv("SPECTRACE_DATA");
  return folder != nullptr ? std::filesystem::path(folder)
                           : std::filesystem::path(SPECTRACE_SOURCE_DIR) / "../shared/data";
}

/// The measurements of a sub-folder ("epfl_rgb"), sorted by name; empty where it is absent.
inline std::vector<std::filesystem::path> measured_files(const std::string& sub_folder,
                                                         const std::string& extension = ".bsdf") {
  std::vector<std::filesystem::path> files;
  std::error_code absent;
  for (const auto& entry : std::filesystem::directory_iterator(data_folder() / sub_folder, absent)) {
    if (entry.path().extension() == extension) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace spectrace::test

/// First line of a test on shared data: `const auto file = data_folder() / "epfl_rgb/...";`
#define SPECTRACE_SKIP_WITHOUT(file)                               \
  if (!std::filesystem::exists(file)) {                            \
    GTEST_SKIP() << "needs " << (file) << " (set SPECTRACE_DATA)"; \
  }                                                                \
  static_assert(true)
