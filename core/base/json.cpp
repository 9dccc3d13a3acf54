// SPDX-License-Identifier: Apache-2.0
#include "core/base/json.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/file.h"
#include "core/base/json_state.h"
#include "core/base/nearest.h"

namespace spectrace {

namespace {

constexpr std::size_t kMaxJsonBytes = std::size_t(256)
                                      << 20;     // a mesh given in place is the largest we expect
constexpr std::size_t kQuotedCharacters = 40;    // of a wrong value, in messages
constexpr double kLargestExactInteger = 0x1p53;  // 8e3 may stand for 8000, 1e300 for no integer

const JsonNode& node_of(const void* node) { return *static_cast<const JsonNode*>(node); }

/// What stands there, as the user wrote it.
std::string found(const JsonState& state, const JsonNode& node) {
  if (node.kind == JsonKind::kArray) return fmt::format("an array of {}", node.children.size());
  if (node.kind == JsonKind::kObject) return "an object";
  std::string text = state.text.substr(node.offset, node.end - node.offset);
  if (text.size() <= kQuotedCharacters) return text;
  std::size_t cut = kQuotedCharacters;
  while ((static_cast<unsigned char>(text[cut]) & 0xC0) == 0x80) --cut;  // never inside a character
  return text.substr(0, cut) + (node.kind == JsonKind::kString ? "...\"" : "...");
}

std::string quoted_list(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += fmt::format("{}\"{}\"", text.empty() ? "" : ", ", name);
  return text;
}

std::string integer_expectation(std::int64_t min, std::int64_t max) {
  const bool has_min = min != std::numeric_limits<std::int64_t>::min();
  const bool has_max = max != std::numeric_limits<std::int64_t>::max();
  if (has_min && has_max) return fmt::format("an integer in [{}, {}]", min, max);
  if (has_min) return fmt::format("an integer of at least {}", min);
  if (has_max) return fmt::format("an integer of at most {}", max);
  return "an integer";
}

std::string array_expectation(std::size_t min_size, std::size_t max_size) {
  const auto numbers = [](std::size_t n) { return n == 1 ? "number" : "numbers"; };
  if (min_size == max_size) return fmt::format("an array of {} {}", min_size, numbers(min_size));
  if (max_size == std::numeric_limits<std::size_t>::max()) {
    return fmt::format("an array of at least {} {}", min_size, numbers(min_size));
  }
  return fmt::format("an array of {} to {} numbers", min_size, max_size);
}

}  // namespace

bool NumberRange::contains(double x) const {
  return (min_open ? x > min : x >= min) && (max_open ? x < max : x <= max);
}

std::string NumberRange::text() const {
  // Nobody who reads of it means the largest number that a Float holds.
  constexpr double kLargest = std::numeric_limits<float>::max();
  const bool has_min = min > -kLargest, has_max = max < kLargest;
  if (has_min && !has_max) return fmt::format("{} {}", min_open ? ">" : ">=", min);
  if (has_max && !has_min) return fmt::format("{} {}", max_open ? "<" : "<=", max);
  return fmt::format("in {}{}, {}{}", min_open || !has_min ? '(' : '[', min, max,
                     max_open || !has_max ? ')' : ']');
}

bool JsonValue::exists() const { return node_ != nullptr; }
bool JsonValue::is_object() const { return exists() && node_of(node_).kind == JsonKind::kObject; }
bool JsonValue::is_array() const { return exists() && node_of(node_).kind == JsonKind::kArray; }
bool JsonValue::is_string() const { return exists() && node_of(node_).kind == JsonKind::kString; }
bool JsonValue::is_number() const {
  return exists() && (node_of(node_).kind == JsonKind::kInteger || node_of(node_).kind == JsonKind::kReal);
}
bool JsonValue::is_integer() const { return exists() && node_of(node_).kind == JsonKind::kInteger; }

JsonValue JsonValue::get(std::string_view key) const {
  if (!exists()) return {state_, nullptr};
  if (!is_object()) {
    expected("an object");
    return {state_, nullptr};
  }
  const JsonNode& object = node_of(node_);
  if (std::find(object.asked.begin(), object.asked.end(), key) == object.asked.end()) {
    object.asked.emplace_back(key);
  }
  const auto member = object.by_key.find(key);
  return {state_, member == object.by_key.end() ? nullptr : member->second};
}

JsonValue JsonValue::require(std::string_view key) const {
  const JsonValue member = get(key);
  if (is_object() && !member.exists()) error(fmt::format("missing required key \"{}\"", key));
  return member;
}

void JsonValue::reject_unknown_keys() const {
  if (!is_object()) return;
  const JsonNode& object = node_of(node_);
  for (const JsonNode* child : object.children) {
    const bool is_known =
        std::find(object.asked.begin(), object.asked.end(), child->key) != object.asked.end();
    if (is_known || child->key.starts_with('$')) continue;
    std::string hint = suggestion(child->key, object.asked);
    if (hint.empty() && !object.asked.empty())
      hint = fmt::format("; known here: {}", quoted_list(object.asked));
    std::string problem = fmt::format("unknown key \"{}\"{}", child->key, hint);
    state_->add(child->key_offset, json_pointer(*child), std::move(problem));
  }
}

std::vector<std::string> JsonValue::keys() const {
  std::vector<std::string> names;
  if (!exists()) return names;
  if (!is_object()) {
    expected("an object");
    return names;
  }
  for (const JsonNode* child : node_of(node_).children) names.push_back(child->key);
  return names;
}

double JsonValue::number(double fallback, NumberRange range) const {
  if (!exists()) return fallback;
  if (is_number() && range.contains(node_of(node_).number)) return node_of(node_).number;
  const bool is_bounded = std::isfinite(range.min) || std::isfinite(range.max);
  expected(is_bounded ? fmt::format("a number {}", range.text()) : "a number");
  return fallback;
}

std::int64_t JsonValue::integer(std::int64_t fallback, std::int64_t min, std::int64_t max) const {
  if (!exists()) return fallback;
  const JsonNode& node = node_of(node_);
  const bool is_exact_real = node.kind == JsonKind::kReal && std::abs(node.number) <= kLargestExactInteger &&
                             node.number == std::trunc(node.number);
  if (node.kind == JsonKind::kInteger || is_exact_real) {
    const std::int64_t value = is_exact_real ? static_cast<std::int64_t>(node.number) : node.integer;
    if (value >= min && value <= max) return value;
  }
  expected(integer_expectation(min, max));
  return fallback;
}

bool JsonValue::boolean(bool fallback) const {
  if (!exists()) return fallback;
  if (node_of(node_).kind == JsonKind::kBoolean) return node_of(node_).integer != 0;
  expected("true or false");
  return fallback;
}

std::string JsonValue::string(std::string_view fallback) const {
  if (!exists()) return std::string(fallback);
  if (is_string()) return node_of(node_).text;
  expected("a string");
  return std::string(fallback);
}

std::string JsonValue::choice(std::string_view fallback,
                              std::initializer_list<std::string_view> allowed) const {
  if (!exists()) return std::string(fallback);
  const std::vector<std::string> names(allowed.begin(), allowed.end());
  const std::string text = node_of(node_).text;
  if (is_string() && std::find(names.begin(), names.end(), text) != names.end()) return text;
  expected(fmt::format("{}{}", names.size() == 1 ? "" : "one of ", quoted_list(names)),
           is_string() ? suggestion(text, names) : "");
  return std::string(fallback);
}

std::vector<double> JsonValue::numbers(std::size_t min_size, std::size_t max_size, NumberRange range) const {
  if (!exists()) return {};
  const JsonNode& array = node_of(node_);
  if (!is_array() || array.children.size() < min_size || array.children.size() > max_size) {
    expected(array_expectation(min_size, max_size));
    return {};
  }
  std::vector<double> values;
  values.reserve(array.children.size());
  bool all_right = true;
  for (const JsonValue& element : elements()) {
    // number() records what is wrong, but its return value cannot tell.
    all_right = all_right && element.is_number() && range.contains(node_of(element.node_).number);
    values.push_back(element.number(0, range));
  }
  return all_right ? values : std::vector<double>{};
}

Vec3 JsonValue::vec3(Vec3 fallback) const {
  constexpr double kLargest = std::numeric_limits<Float>::max();
  const std::vector<double> v = numbers(3, 3, {.min = -kLargest, .max = kLargest});
  if (v.empty()) return fallback;
  return Vec3{static_cast<Float>(v[0]), static_cast<Float>(v[1]), static_cast<Float>(v[2])};
}

std::vector<JsonValue> JsonValue::elements() const {
  std::vector<JsonValue> values;
  if (!exists()) return values;
  if (!is_array()) {
    expected("an array");
    return values;
  }
  for (const JsonNode* child : node_of(node_).children) values.push_back(JsonValue(state_, child));
  return values;
}

std::filesystem::path JsonValue::path() const {
  if (!exists()) return {};
  const std::string name = is_string() ? node_of(node_).text : "";
  // An escaped NUL would silently cut the name at the system call.
  if (name.empty() || name.find('\0') != std::string::npos) {
    expected("a file name");
    return {};
  }
  return state_->files.emplace_back(std::filesystem::path(state_->file_name).parent_path() / name);
}

void JsonValue::expected(std::string_view what, std::string_view hint) const {
  error(fmt::format("expected {}, got {}{}", what, found(*state_, node_of(node_)), hint));
}

void JsonValue::error(std::string problem) const {
  SPECTRACE_CHECK(state_ != nullptr);
  if (exists()) {
    state_->add(node_of(node_).offset, pointer(), std::move(problem));
  } else {
    state_->add(state_->root->offset, "", std::move(problem));
  }
}

std::string JsonValue::pointer() const { return exists() ? json_pointer(node_of(node_)) : std::string(); }

std::string JsonValue::where() const {
  if (!exists()) return {};
  const std::string place = state_->line_and_column(node_of(node_).offset), at = pointer();
  return at.empty() ? place : fmt::format("{}: {}", place, at);
}

JsonDocument JsonDocument::load(const std::filesystem::path& file) {
  const std::vector<std::byte> bytes = read_file(file, kMaxJsonBytes);
  return parse(std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()), file.string());
}

JsonDocument JsonDocument::parse(std::string text, std::string file_name) {
  auto state = std::make_unique<JsonState>();
  state->text = std::move(text);
  state->file_name = std::move(file_name);
  parse_json(*state);
  state->throw_if_wrong();
  return JsonDocument(std::move(state));
}

JsonDocument::JsonDocument(std::unique_ptr<JsonState> state) : state_(std::move(state)) {}
JsonDocument::JsonDocument(JsonDocument&&) noexcept = default;
JsonDocument& JsonDocument::operator=(JsonDocument&&) noexcept = default;
JsonDocument::~JsonDocument() = default;

JsonValue JsonDocument::root() { return {state_.get(), state_->root}; }
const std::string& JsonDocument::file_name() const { return state_->file_name; }
const std::vector<std::filesystem::path>& JsonDocument::files() const { return state_->files; }

const std::vector<Diagnostic>& JsonDocument::diagnostics() const { return state_->diagnostics; }
void JsonDocument::throw_if_wrong() const { state_->throw_if_wrong(); }

}  // namespace spectrace
