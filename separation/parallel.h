// SPDX-License-Identifier: Apache-2.0
// Loops over chunks of work whose results do not depend on the number of threads.
#pragma once

#include <cstddef>
#include <functional>

namespace spectrace {

/// Runs `work` with at most `threads` threads (0 = all cores) for every parallel_chunks() below it.
void with_threads(int threads, const std::function<void()>& work);

/// Calls `body(i)` for i in [0, count), in any order and on any thread. For the result to be the same bit for
/// bit, each call writes only to places of its own, and sums over calls are taken afterwards, in order.
void parallel_chunks(std::size_t count, const std::function<void(std::size_t)>& body);

}  // namespace spectrace
