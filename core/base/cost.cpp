// SPDX-License-Identifier: Apache-2.0
#include "core/base/cost.h"

#include <sys/resource.h>

#include <fstream>

namespace spectrace {

std::size_t peak_memory_bytes() {
  rusage usage{};
  if (getrusage(RUSAGE_SELF, &usage) != 0) return 0;
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024;  // Linux counts kibibytes
}

void reset_peak_memory() {
  // proc(5): 5 resets the peak resident set size. Where it cannot be written the peak is that of all so far.
  std::ofstream("/proc/self/clear_refs") << 5;
}

}  // namespace spectrace
