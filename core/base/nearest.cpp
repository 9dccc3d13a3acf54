// SPDX-License-Identifier: Apache-2.0
#include "core/base/nearest.h"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <vector>

namespace spectrace {
namespace {

// Longer words are no typing errors of a key; the cap bounds the time a hostile file can take.
constexpr std::size_t kMaxLength = 64;
constexpr std::size_t kShortestBeginning = 3;  // letters that say which name is meant

std::string lower(std::string_view text) {
  std::string r(text);
  std::transform(r.begin(), r.end(), r.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return r;
}

/// Optimal string alignment distance.
std::size_t edits(const std::string& a, const std::string& b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) {
    d[i][0] = i;
  }
  for (std::size_t j = 0; j <= b.size(); ++j) {
    d[0][j] = j;
  }
  for (std::size_t i = 1; i <= a.size(); ++i) {
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = d[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, replaced});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
      }
    }
  }
  return d[a.size()][b.size()];
}

}  // namespace

std::optional<std::string> nearest_name(std::string_view word, std::span<const std::string> known) {
  if (word.size() > kMaxLength) {
    return std::nullopt;
  }
  const std::string wanted = lower(word);
  std::optional<std::string> best;
  std::size_t fewest = 0;
  for (const std::string& name : known) {
    if (name.size() > kMaxLength) {
      continue;
    }
    const std::string candidate = lower(name);
    // "fov" is no typing error of "fov_deg", but what is meant is plain.
    const bool is_begun = wanted.size() >= kShortestBeginning && candidate.starts_with(wanted);
    const std::size_t n = is_begun ? 1 : edits(wanted, candidate);
    if (n <= std::max<std::size_t>(2, name.size() / 3) && n < name.size() && (!best || n < fewest)) {
      best = name;
      fewest = n;
    }
  }
  return best;
}

std::string suggestion(std::string_view word, std::span<const std::string> known) {
  const auto name = nearest_name(word, known);
  return name ? "; did you mean \"" + *name + "\"?" : "";
}

}  // namespace spectrace
