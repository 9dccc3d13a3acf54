// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

namespace spectrace {

/// FNV-1a over whole words: collisions only cost time, equality decides.
struct WordsHash {
  template <typename Words>
  std::size_t operator()(const Words& words) const {
    std::uint64_t h = 0xcbf29ce484222325U;
    for (auto word : words) {
      h = (h ^ static_cast<std::uint64_t>(word)) * 0x100000001b3U;
      h ^= h >> 29U;
    }
    return h;
  }
};

}  // namespace spectrace
