// SPDX-License-Identifier: Apache-2.0
// What the fuzz targets share: bytes go into a reader, which accepts them or throws InputError. Anything else
// is a finding.
#pragma once

#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>

#include "core/base/error.h"

namespace spectrace::test {

/// A file in memory where the system has one (/dev/shm), for readers that take a name; gone at the end.
class InputFile {
 public:
  InputFile(std::span<const std::byte> bytes, const std::string& extension) {
    const std::filesystem::path memory = "/dev/shm";
    const auto folder =
        std::filesystem::is_directory(memory) ? memory : std::filesystem::temp_directory_path();
    path_ = folder / ("spectrace-fuzz-" + std::to_string(::getpid()) + extension);
    std::ofstream(path_, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  }
  ~InputFile() {
    std::error_code ignored;  // left behind, it is overwritten by the next
    std::filesystem::remove(path_, ignored);
  }
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// Of the processor's time: on a machine that does other things too, a clock on the wall finds hangs that are
/// none.
inline double processor_seconds() { return double(std::clock()) / CLOCKS_PER_SEC; }
inline constexpr double kMostSeconds = 1;

template <typename Read>
int accept_or_refuse(const std::uint8_t* data, std::size_t size, const Read& read) {
  const double begin = processor_seconds();
  try {
    read(std::as_bytes(std::span(data, size)));
  } catch (const InputError& e) {
    SPECTRACE_CHECK(!e.diagnostics().empty() && !e.diagnostics().front().problem.empty());
  }
  SPECTRACE_CHECK(processor_seconds() - begin <= kMostSeconds);
  return 0;
}

}  // namespace spectrace::test
