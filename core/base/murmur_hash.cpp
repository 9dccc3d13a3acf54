// SPDX-License-Identifier: Apache-2.0
#include "core/base/murmur_hash.h"

#include <bit>
#include <cstddef>

namespace spectrace {

namespace {

/// Up to four bytes as a little-endian number, spread over all bits.
std::uint32_t spread(std::string_view bytes) {
  std::uint32_t word = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i) word |= std::uint32_t(std::uint8_t(bytes[i])) << (8 * i);
  return std::rotl(word * 0xcc9e2d51U, 15) * 0x1b873593U;
}

}  // namespace

std::uint32_t murmur_hash3_32(std::string_view bytes, std::uint32_t seed) {
  std::uint32_t hash = seed;
  for (std::size_t i = 0; i < bytes.size(); i += 4) {
    const std::string_view block = bytes.substr(i, 4);
    hash ^= spread(block);
    if (block.size() == 4) hash = std::rotl(hash, 13) * 5 + 0xe6546b64U;
  }
  hash ^= std::uint32_t(bytes.size());
  hash = (hash ^ hash >> 16) * 0x85ebca6bU;
  hash = (hash ^ hash >> 13) * 0xc2b2ae35U;
  return hash ^ hash >> 16;
}

}  // namespace spectrace
