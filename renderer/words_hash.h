// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

namespace spectrace {

/// FNV-1a over whole words. In hash tables collisions only cost time, equality decides.
struct WordsHash {
  static constexpr std::uint64_t kStart = 0xcbf29ce484222325U;
  /// One to one in either argument: a single wrong word never goes unnoticed.
  static std::uint64_t add(std::uint64_t h, std::uint64_t word) {
    h = (h ^ word) * 0x100000001b3U;
    return h ^ (h >> 29U);
  }
  template <typename Words>
  std::size_t operator()(const Words& words) const {
    std::uint64_t h = kStart;
    for (auto word : words) h = add(h, static_cast<std::uint64_t>(word));
    return h;
  }
};

}  // namespace spectrace
