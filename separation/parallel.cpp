// SPDX-License-Identifier: Apache-2.0
#include "separation/parallel.h"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>

namespace spectrace {

void with_threads(int threads, const std::function<void()>& work) {
  // More threads than cores are a user's to ask for; the arena alone would not make them.
  const std::size_t allowed = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  std::max(static_cast<std::size_t>(std::max(threads, 1)), allowed));
  tbb::task_arena arena(threads > 0 ? threads : tbb::task_arena::automatic);
  arena.execute([&] { work(); });
}

void parallel_chunks(std::size_t count, const std::function<void(std::size_t)>& body) {
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) { body(i); });
}

}  // namespace spectrace
