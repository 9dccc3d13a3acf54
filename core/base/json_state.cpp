// SPDX-License-Identifier: Apache-2.0
#include "core/base/json_state.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "core/base/json.h"

namespace spectrace {

namespace {

/// Levenshtein's distance: insertions, deletions and substitutions, each 1.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t(0));
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t substituted = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({row[j] + 1, row[j + 1] + 1, substituted});
    }
  }
  return row.back();
}

}  // namespace

std::string nearest_name(std::string_view name, const std::vector<std::string>& candidates) {
  // One slip in three letters, at least two: "fvo" is "fov", "colour" is not "radius". The length also bounds
  // the work that a hostile name can cause.
  constexpr std::size_t kLongestName = 64;
  if (name.size() > kLongestName) return {};
  std::string best;
  std::size_t best_distance = std::max<std::size_t>(2, name.size() / 3) + 1;
  for (const std::string& candidate : candidates) {
    const std::size_t distance = edit_distance(name, candidate);
    if (distance < best_distance && distance < candidate.size()) {
      best = candidate;
      best_distance = distance;
    }
  }
  return best;
}

std::string json_pointer(const JsonNode& node) {
  std::vector<const JsonNode*> path;
  for (const JsonNode* n = &node; n->parent != nullptr; n = n->parent) path.push_back(n);
  std::string text;
  for (auto it = path.rbegin(); it != path.rend(); ++it) {
    text += '/';
    if ((*it)->parent->kind == JsonKind::kArray) {
      text += std::to_string((*it)->index);
      continue;
    }
    for (const char c : (*it)->key) {
      if (c == '~') {
        text += "~0";
      } else if (c == '/') {
        text += "~1";
      } else {
        text += c;
      }
    }
  }
  return text;
}

std::string JsonState::line_and_column(std::size_t offset) const {
  const auto after = std::upper_bound(line_starts.begin(), line_starts.end(), offset);
  const std::size_t line = static_cast<std::size_t>(after - line_starts.begin());
  const std::size_t begin = line_starts[line - 1];
  const auto starts_character = [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; };
  const auto column = std::count_if(text.begin() + static_cast<std::ptrdiff_t>(begin),
                                    text.begin() + static_cast<std::ptrdiff_t>(offset), starts_character);
  return fmt::format("{}:{}", line, column + 1);
}

void JsonState::add(std::size_t offset, const std::string& pointer, std::string problem) {
  const std::string place = line_and_column(offset);
  Diagnostic diagnostic{file_name, pointer.empty() ? place : fmt::format("{}: {}", place, pointer),
                        std::move(problem)};
  const auto [first, last] = std::equal_range(offsets.begin(), offsets.end(), offset);
  for (auto it = first; it != last; ++it) {
    if (diagnostics[static_cast<std::size_t>(it - offsets.begin())].problem == diagnostic.problem) return;
  }
  if (diagnostics.size() == kMaxDiagnostics) {
    ++unlisted;
    return;
  }
  diagnostics.insert(diagnostics.begin() + (last - offsets.begin()), std::move(diagnostic));
  offsets.insert(last, offset);
}

void JsonState::throw_if_wrong() const {
  if (diagnostics.empty()) return;
  std::vector<Diagnostic> all = diagnostics;
  if (unlisted > 0) all.push_back({file_name, "", fmt::format("and {} more problems", unlisted)});
  throw InputError(std::move(all));
}

}  // namespace spectrace
