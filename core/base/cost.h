// SPDX-License-Identifier: Apache-2.0
// What a piece of work costs.
#pragma once

#include <chrono>
#include <cstddef>

namespace spectrace {

/// Runs `step` and returns how long it took [s].
template <typename F>
double seconds_of(const F& step) {
  const auto start = std::chrono::steady_clock::now();
  step();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// The most memory this process has held at once, so far or since reset_peak_memory(); 0 where the system
/// does not tell.
std::size_t peak_memory_bytes();
/// The most from now on, where the system can start again (Linux); else as before.
void reset_peak_memory();

}  // namespace spectrace
