// SPDX-License-Identifier: Apache-2.0
#include "core/base/json_state.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/json.h"

namespace spectrace {

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
