// SPDX-License-Identifier: Apache-2.0
// Text to tree. The library validates and decodes; a second, simple walk over the same text gives each of
// its events the place that the library does not tell.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "core/base/json_state.h"

namespace spectrace {

namespace {

constexpr std::size_t kMaxDepth = 200;  // H19: a scene needs about ten
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

/// Offset of the first byte that is not UTF-8 (Unicode 15, table 3-7), or is NUL, which the library would
/// take for the end of the text.
std::optional<std::size_t> find_bad_byte(std::string_view text) {
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
  for (std::size_t i = 0; i < text.size();) {
    const unsigned lead = byte(i);
    std::size_t length = 1;
    unsigned low = 0x80, high = 0xBF;  // of the second byte; narrower after four leads
    if (lead == 0) return i;
    if (lead >= 0x80) {
      if (lead < 0xC2 || lead > 0xF4) return i;
      length = lead < 0xE0 ? 2 : lead < 0xF0 ? 3 : 4;
      if (lead == 0xE0) low = 0xA0;
      if (lead == 0xED) high = 0x9F;
      if (lead == 0xF0) low = 0x90;
      if (lead == 0xF4) high = 0x8F;
      if (byte(i + 1) < low || byte(i + 1) > high) return i;
      for (std::size_t k = 2; k < length; ++k) {
        if (byte(i + k) < 0x80 || byte(i + k) > 0xBF) return i;
      }
    }
    i += length;
  }
  return std::nullopt;
}

/// Walks a text whose tokens the library has just accepted.
class Scanner {
 public:
  explicit Scanner(std::string_view text) : text_(text) {
    if (text_.starts_with(kByteOrderMark)) position_ = kByteOrderMark.size();
  }

  struct Token {
    std::size_t begin, end;
  };

  /// The next key, scalar or bracket; separators, white space and comments are passed over.
  Token next() {
    skip_to_token();
    const std::size_t begin = position_;
    const char c = peek();
    if (c == '"') {
      skip_string();
    } else if (c == '{' || c == '}' || c == '[' || c == ']') {
      ++position_;
    } else {
      position_ = std::min(text_.find_first_of(" \t\r\n,:/{}[]\"", position_), text_.size());
    }
    return {begin, position_};
  }

 private:
  [[nodiscard]] char peek(std::size_t ahead = 0) const {
    return position_ + ahead < text_.size() ? text_[position_ + ahead] : '\0';
  }

  void skip_to_token() {
    for (;;) {
      const char c = peek();
      if (c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == ',' || c == ':') {
        ++position_;
      } else if (c == '/') {
        const bool is_line = peek(1) == '/';
        const std::size_t found = text_.find(is_line ? "\n" : "*/", position_ + 2);
        position_ = found == std::string_view::npos ? text_.size() : found + (is_line ? 1 : 2);
      } else {
        return;
      }
    }
  }

  void skip_string() {
    ++position_;
    while (position_ < text_.size() && peek() != '"') position_ += peek() == '\\' ? 2 : 1;
    position_ = std::min(position_ + 1, text_.size());
  }

  std::string_view text_;
  std::size_t position_ = 0;
};

/// The library's sentence without its own counting of places and without a quotation of unbounded length.
std::string library_problem(std::string message) {
  for (const std::string_view prefix : {"] ", "syntax error "}) {
    if (const std::size_t at = message.find(prefix); at != std::string::npos) {
      message.erase(0, at + prefix.size());
    }
  }
  const std::size_t quote = message.find("; last read: '");
  if (quote != std::string::npos) message.erase(quote, message.rfind('\'') + 1 - quote);
  return message;
}

/// Receives the library's events in document order.
class TreeBuilder {
 public:
  explicit TreeBuilder(JsonState& state) : state_(state), scanner_(state.text) {}

  bool null() { return add(JsonKind::kNull), true; }
  bool boolean(bool value) { return add(JsonKind::kBoolean).integer = value, true; }
  bool number_integer(std::int64_t value) { return add_integer(value); }
  bool number_unsigned(std::uint64_t value) {
    if (std::in_range<std::int64_t>(value)) return add_integer(static_cast<std::int64_t>(value));
    return number_float(static_cast<double>(value), {});
  }
  bool number_float(double value, const std::string&) { return add(JsonKind::kReal).number = value, true; }
  bool string(std::string& value) { return add(JsonKind::kString).text = std::move(value), true; }
  bool binary(nlohmann::json::binary_t&) { return false; }  // not in text
  bool start_object(std::size_t) { return open(JsonKind::kObject); }
  bool start_array(std::size_t) { return open(JsonKind::kArray); }
  bool end_object() { return close(); }
  bool end_array() { return close(); }
  bool key(std::string& name) {
    key_offset_ = scanner_.next().begin;
    key_ = std::move(name);
    return true;
  }

  bool parse_error(std::size_t position, const std::string& token, const nlohmann::detail::exception& fault) {
    // `position` counts the bytes read. Point to the begin of a whole word, number or string that stands in
    // the wrong place; otherwise to the last byte read, which is what the library did not like.
    const std::string& text = state_.text;
    std::size_t offset = position > 0 ? std::min(position - 1, text.size()) : 0;
    const bool is_whole_token = std::string_view(fault.what()).find("last read") == std::string_view::npos;
    const bool is_separator =
        offset < text.size() && std::string_view(",:[]{}").find(text[offset]) != std::string_view::npos;
    if (is_whole_token && !is_separator && !token.empty() && position <= text.size() &&
        std::string_view(text).substr(0, position).ends_with(token)) {
      offset = position - token.size();
    }
    state_.add(offset, "", fmt::format("not valid JSON: {}", library_problem(fault.what())));
    return false;
  }

 private:
  JsonNode& add(JsonKind kind) {
    const auto [begin, end] = scanner_.next();
    JsonNode& node = state_.nodes.emplace_back();
    node.kind = kind;
    node.offset = begin;
    node.end = end;
    if (open_.empty()) {
      state_.root = &node;
      return node;
    }
    JsonNode& parent = *open_.back();
    node.parent = &parent;
    node.index = parent.children.size();
    parent.children.push_back(&node);
    if (parent.kind == JsonKind::kObject) {
      node.key = std::move(key_);
      node.key_offset = key_offset_;
      const auto [first, is_new] = parent.by_key.emplace(node.key, &node);
      if (!is_new) {
        state_.add(node.key_offset, json_pointer(node),
                   fmt::format("duplicate key \"{}\", first given at {}", node.key,
                               state_.line_and_column(first->second->key_offset)));
      }
    }
    return node;
  }

  bool add_integer(std::int64_t value) {
    JsonNode& node = add(JsonKind::kInteger);
    node.integer = value;
    node.number = static_cast<double>(value);
    return true;
  }

  bool open(JsonKind kind) {
    JsonNode& node = add(kind);
    open_.push_back(&node);
    if (open_.size() <= kMaxDepth) return true;
    state_.add(node.offset, "", fmt::format("nested more than {} levels deep", kMaxDepth));
    return false;
  }

  bool close() {
    scanner_.next();
    open_.pop_back();
    return true;
  }

  JsonState& state_;
  Scanner scanner_;
  std::vector<JsonNode*> open_;
  std::string key_;
  std::size_t key_offset_ = 0;
};

}  // namespace

void parse_json(JsonState& state) {
  state.line_starts = {0};
  for (std::size_t i = 0; i < state.text.size(); ++i) {
    if (state.text[i] == '\n') state.line_starts.push_back(i + 1);
  }
  if (const std::optional<std::size_t> bad = find_bad_byte(state.text)) {
    state.add(*bad, "",
              fmt::format("not valid JSON: byte 0x{:02x} is not UTF-8 text",
                          static_cast<unsigned char>(state.text[*bad])));
    return;
  }
  TreeBuilder builder(state);
  constexpr bool kStrict = true, kIgnoreComments = true;
  nlohmann::json::sax_parse(state.text, &builder, nlohmann::json::input_format_t::json, kStrict,
                            kIgnoreComments);
}

}  // namespace spectrace
