// SPDX-License-Identifier: Apache-2.0
#include "separation/parallel.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace spectrace {

void with_threads(int threads, const std::function<void()>& work) {
  tbb::task_arena arena(threads > 0 ? threads : tbb::task_arena::automatic);
  arena.execute([&] { work(); });
}

void parallel_chunks(std::size_t count, const std::function<void(std::size_t)>& body) {
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) { body(i); });
}

}  // namespace spectrace
