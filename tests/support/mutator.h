// SPDX-License-Identifier: Apache-2.0
// Damages files as disks, editors, exporters and enemies do: the same damage for the same seed on every
// platform.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "tests/support/chi_square.h"

namespace spectrace::test {

class Mutator {
 public:
  explicit Mutator(std::uint64_t seed) : random_(seed) {}

  /// Flipped bits, a cut end, numbers replaced by 1e400, -1, NaN and the like, words and lines removed, given
  /// twice or exchanged, invalid UTF-8, deep nesting. One to three of these.
  std::string mutate_text(std::string text);
  /// Flipped bits, a cut end, words of 1 to 8 bytes replaced by extreme numbers, stretches removed, given
  /// twice or exchanged, every other time within the first kilobyte, where headers are. One to three of
  /// these.
  std::string mutate_binary(std::string bytes);

 private:
  std::size_t below(std::size_t bound);
  template <typename Mutation>
  std::string several(std::string bytes, const Mutation& mutation);
  template <typename T, std::size_t n>
  const T& one_of(const T (&list)[n]) {  // NOLINT(cppcoreguidelines-avoid-c-arrays): takes their length
    return list[below(n)];
  }
  void mutate_text_once(std::string& text);
  void mutate_binary_once(std::string& bytes);
  void flip_bits(std::string& bytes, std::size_t range);
  void replace_number(std::string& text);
  void move_stretch(std::string& bytes, std::size_t begin, std::size_t length);

  TestRandom random_;
};

}  // namespace spectrace::test
