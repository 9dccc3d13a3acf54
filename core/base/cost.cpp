// SPDX-License-Identifier: Apache-2.0
#include "core/base/cost.h"

#include <sys/resource.h>

namespace spectrace {

std::size_t peak_memory_bytes() {
  rusage usage{};
  if (getrusage(RUSAGE_SELF, &usage) != 0) return 0;
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024;  // Linux counts kibibytes
}

}  // namespace spectrace
