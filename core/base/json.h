// SPDX-License-Identifier: Apache-2.0
// Reading JSON (comments allowed) so that every mistake is named with file, line, column and pointer,
// all mistakes of a file at once. The one door to the JSON library.
#pragma once

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "core/base/error.h"
#include "core/math/vec.h"

namespace spectrace {

/// A closed or half-open interval a number must lie in; printed as "in (0, 1]" or "> 0" in messages.
struct NumberRange {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool min_open = false;
  bool max_open = false;

  [[nodiscard]] bool contains(double x) const;  ///< false for NaN
  [[nodiscard]] std::string text() const;
};
inline constexpr NumberRange kAnyNumber{};
inline constexpr NumberRange kPositive{.min = 0, .min_open = true};
inline constexpr NumberRange kNonNegative{.min = 0};
inline constexpr NumberRange kUnitInterval{.min = 0, .max = 1};

struct JsonState;  // what a document holds (json_state.h)

/// A place in a document, or the lack of one (`exists() == false`) below an absent key. A read that fails
/// records a Diagnostic in the document and returns `fallback`, so that parsing goes on and finds the rest.
/// Copies are cheap; a value must not outlive its document.
class JsonValue {
 public:
  JsonValue() = default;  ///< does not exist
  [[nodiscard]] bool exists() const;
  [[nodiscard]] bool is_object() const;
  [[nodiscard]] bool is_array() const;
  [[nodiscard]] bool is_string() const;
  [[nodiscard]] bool is_number() const;
  [[nodiscard]] bool is_integer() const;  ///< a number without point or exponent, of 64 bits

  /// The member `key` of an object. Asking makes the key known, see reject_unknown_keys(). Absent: a value
  /// that does not exist. Not an object: recorded.
  [[nodiscard]] JsonValue get(std::string_view key) const;
  /// As get(), but an absent key is recorded ("missing required key \"fov\"").
  [[nodiscard]] JsonValue require(std::string_view key) const;
  /// Records every key of this object that was never asked for, with the nearest key that was. Keys that
  /// begin with '$' ("$schema") are allowed.
  void reject_unknown_keys() const;
  /// All keys of this object, in file order.
  [[nodiscard]] std::vector<std::string> keys() const;

  /// Typed reads. On a value that does not exist: `fallback`, nothing recorded.
  [[nodiscard]] double number(double fallback, NumberRange range = kAnyNumber) const;
  [[nodiscard]] std::int64_t integer(std::int64_t fallback, std::int64_t min, std::int64_t max) const;
  [[nodiscard]] bool boolean(bool fallback) const;
  [[nodiscard]] std::string string(std::string_view fallback = "") const;
  /// A string that must be one of `allowed`; recorded with the nearest one otherwise.
  [[nodiscard]] std::string choice(std::string_view fallback,
                                   std::initializer_list<std::string_view> allowed) const;
  /// Array of numbers whose length lies in [min_size, max_size]; empty where it is absent or wrong.
  [[nodiscard]] std::vector<double> numbers(std::size_t min_size, std::size_t max_size,
                                            NumberRange range = kAnyNumber) const;
  [[nodiscard]] Vec3 vec3(Vec3 fallback) const;
  /// Elements of an array; empty where it does not exist.
  [[nodiscard]] std::vector<JsonValue> elements() const;
  /// A file name, relative to the document's own folder unless absolute; empty where it is absent or wrong.
  /// Existence is not checked.
  [[nodiscard]] std::filesystem::path path() const;

  /// Records a problem at this place.
  void error(std::string problem) const;
  /// JSON pointer (RFC 6901), "" for the root.
  [[nodiscard]] std::string pointer() const;
  /// "41:18: /materials/2/roughness": what goes into Diagnostic::where.
  [[nodiscard]] std::string where() const;

 private:
  friend class JsonDocument;
  JsonValue(JsonState* state, const void* node) : state_(state), node_(node) {}
  /// Records "expected <what>, got <the text there><hint>".
  void expected(std::string_view what, std::string_view hint = "") const;
  JsonState* state_ = nullptr;
  const void* node_ = nullptr;  // owned by the state; null where absent
};

/// A file with more mistakes than this is not the file that was meant; the rest is only counted.
inline constexpr std::size_t kMaxDiagnostics = 100;

/// One parsed file.
class JsonDocument {
 public:
  /// Throws InputError where the file cannot be read or is not JSON (line and column of the first fault;
  /// nesting over 200 levels, duplicate keys and invalid UTF-8 are faults).
  static JsonDocument load(const std::filesystem::path& file);
  static JsonDocument parse(std::string text, std::string file_name);
  JsonDocument(JsonDocument&&) noexcept;
  JsonDocument& operator=(JsonDocument&&) noexcept;
  ~JsonDocument();

  [[nodiscard]] JsonValue root();
  [[nodiscard]] const std::string& file_name() const;
  /// All diagnostics so far, ordered by place; the first kMaxDiagnostics of them that were found.
  [[nodiscard]] const std::vector<Diagnostic>& diagnostics() const;
  /// Every file that JsonValue::path() has been asked for so far.
  [[nodiscard]] const std::vector<std::filesystem::path>& files() const;
  /// Throws InputError with all of them, if there is any.
  void throw_if_wrong() const;

 private:
  std::unique_ptr<JsonState> state_;  // values point to it, not to the document, which may move
  explicit JsonDocument(std::unique_ptr<JsonState> state);
};

/// Writing JSON: a small builder, so that reports need no third-party type. Values keep insertion order.
class JsonWriter {
 public:
  JsonWriter();
  ~JsonWriter();
  JsonWriter(JsonWriter&&) noexcept;
  void begin_object();
  void end_object();
  void begin_array();
  void end_array();
  void key(std::string_view name);
  void value(double x);  ///< NaN and infinities become null
  void value(std::int64_t x);
  void value(bool x);
  void value(std::string_view text);
  void value(const char* text) { value(std::string_view(text)); }
  void null();
  /// key + value
  template <typename T>
  void member(std::string_view name, const T& x) {
    key(name);
    if constexpr (std::is_same_v<T, bool>) {
      value(x);
    } else if constexpr (std::is_integral_v<T>) {
      value(static_cast<std::int64_t>(x));
    } else if constexpr (std::is_arithmetic_v<T>) {
      value(static_cast<double>(x));
    } else {
      value(std::string_view(x));
    }
  }
  /// The text so far, indented by two spaces; all objects and arrays must be closed.
  [[nodiscard]] std::string text() const;
  /// The same in one line, for files that have an object a line.
  [[nodiscard]] std::string line() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace spectrace
