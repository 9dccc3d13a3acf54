// SPDX-License-Identifier: Apache-2.0
// Lines of the text files of meshes and their materials.
#pragma once

#include <string_view>

namespace spectrace {

/// What parts words within a line; lines may end in a carriage return.
inline constexpr std::string_view kBlanks = " \t\r";

/// `text` without blanks before and after.
[[nodiscard]] inline std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1);
}

}  // namespace spectrace
