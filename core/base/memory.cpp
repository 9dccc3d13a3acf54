// SPDX-License-Identifier: Apache-2.0
#include "core/base/memory.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <limits>

#include "core/base/error.h"

namespace spectrace {

namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kNoLimit = std::numeric_limits<std::uint64_t>::max();

/// The number that follows `key` in a file of lines "key number"; without a key the file's first number.
std::optional<std::uint64_t> read_number(const fs::path& file, const std::string& key = {}) {
  std::ifstream in(file);
  std::string word;
  while (!key.empty() && in >> word && word != key) {
  }
  std::uint64_t number = 0;
  if (in >> number) return number;
  return std::nullopt;  // "max", too: no limit
}

std::uint64_t free_of_machine() {
  constexpr std::uint64_t kKibi = 1024;
  const auto available = read_number("/proc/meminfo", "MemAvailable:");
  if (!available) return kNoLimit;
  return (*available + read_number("/proc/meminfo", "SwapFree:").value_or(0)) * kKibi;
}

/// What is left of one group. Its page cache counts as used, and is given back when memory is short.
std::uint64_t left_of_group(const fs::path& group, const char* limit_file, const char* used_file,
                            const char* cache_key) {
  const auto limit = read_number(group / limit_file), used = read_number(group / used_file);
  if (!limit || !used) return kNoLimit;
  const std::uint64_t held =
      *used - std::min(*used, read_number(group / "memory.stat", cache_key).value_or(0));
  return *limit - std::min(*limit, held);
}

/// Of the groups this process is in, and all above them. Lines of /proc/self/cgroup: number:controllers:path.
std::uint64_t left_of_groups() {
  std::uint64_t least = kNoLimit;
  std::ifstream groups("/proc/self/cgroup");
  for (std::string line; std::getline(groups, line);) {
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string controllers = ',' + line.substr(first + 1, second - first - 1) + ',';
    const bool is_v2 = controllers == ",,";
    if (!is_v2 && controllers.find(",memory,") == std::string::npos) continue;
    const fs::path root = is_v2 ? "/sys/fs/cgroup" : "/sys/fs/cgroup/memory";
    for (fs::path path = fs::path(line.substr(second + 1)).relative_path();; path = path.parent_path()) {
      least =
          std::min(least, is_v2 ? left_of_group(root / path, "memory.max", "memory.current", "inactive_file")
                                : left_of_group(root / path, "memory.limit_in_bytes", "memory.usage_in_bytes",
                                                "total_inactive_file"));
      if (path.empty()) break;
    }
  }
  return least;
}

std::uint64_t left_of_address_space() {
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return kNoLimit;
  const std::uint64_t pages = read_number("/proc/self/statm").value_or(0);
  const std::uint64_t taken = pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
  return limit.rlim_cur - std::min<std::uint64_t>(limit.rlim_cur, taken);
}

}  // namespace

std::optional<std::uint64_t> available_memory_bytes() {
  const std::uint64_t least = std::min({free_of_machine(), left_of_groups(), left_of_address_space()});
  return least < kNoLimit ? std::optional(least) : std::nullopt;
}

std::string gigabytes_text(std::uint64_t bytes) { return fmt::format("{:.2f} GB", double(bytes) * 1e-9); }

void require_memory(std::uint64_t needed_bytes, const std::string& file, const std::string& where,
                    const std::string& what) {
  const std::optional<std::uint64_t> available = available_memory_bytes();
  if (!available || needed_bytes <= *available) return;
  throw InputError(file, where,
                   fmt::format("{} takes about {} of memory, and {} are free", what,
                               gigabytes_text(needed_bytes), gigabytes_text(*available)));
}

}  // namespace spectrace
