// SPDX-License-Identifier: Apache-2.0
// What a JsonDocument holds: the tree with its places in the text, and what was found wrong. Internal to
// core/base.
#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.h"

namespace spectrace {

enum class JsonKind : std::uint8_t { kNull, kBoolean, kInteger, kReal, kString, kArray, kObject };

struct JsonNode {
  JsonKind kind = JsonKind::kNull;
  std::size_t offset = 0;  ///< [byte] of the value's first character
  std::size_t end = 0;     ///< [byte] behind the value; of a container: behind its opening bracket
  const JsonNode* parent = nullptr;
  std::size_t index = 0;  ///< among the parent's children
  std::string key;        ///< where the parent is an object
  std::size_t key_offset = 0;
  double number = 0;                ///< kInteger and kReal
  std::int64_t integer = 0;         ///< kInteger; kBoolean as 0 and 1
  std::string text;                 ///< kString
  std::vector<JsonNode*> children;  ///< kArray and kObject, in file order
  std::map<std::string_view, JsonNode*> by_key;
  mutable std::vector<std::string> asked;  ///< keys that the reader of this object knows
};

struct JsonState {
  std::string file_name;
  std::string text;
  std::vector<std::size_t> line_starts;
  std::deque<JsonNode> nodes;  // a deque: nodes point to each other
  const JsonNode* root = nullptr;

  std::vector<Diagnostic> diagnostics;  ///< ordered by place
  std::vector<std::size_t> offsets;     ///< of each diagnostic
  std::size_t unlisted = 0;             ///< found beyond kMaxDiagnostics

  std::vector<std::filesystem::path> files;  ///< that values named, in the order they were asked for

  /// "41:18": counted from 1, the column in characters.
  [[nodiscard]] std::string line_and_column(std::size_t offset) const;
  /// `pointer` may be empty. The same problem at the same place is recorded once.
  void add(std::size_t offset, const std::string& pointer, std::string problem);
  /// Throws InputError where anything was recorded.
  void throw_if_wrong() const;
};

/// JSON pointer (RFC 6901) of a node.
[[nodiscard]] std::string json_pointer(const JsonNode& node);

/// Fills nodes and root from text; faults go to the diagnostics.
void parse_json(JsonState& state);

}  // namespace spectrace
