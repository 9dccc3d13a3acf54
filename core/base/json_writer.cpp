// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/base/json.h"

namespace spectrace {

using Tree = nlohmann::ordered_json;

struct JsonWriter::Impl {
  Tree root;
  std::vector<Tree*> open;  // stays valid: only the innermost container grows
  std::string key;
  bool has_key = false, has_root = false;

  Tree& place() {
    if (open.empty()) {
      SPECTRACE_CHECK(!has_root);
      has_root = true;
      return root;
    }
    Tree& parent = *open.back();
    if (parent.is_array()) return parent.emplace_back();
    SPECTRACE_CHECK(has_key && !parent.contains(key));
    has_key = false;
    return parent[key];
  }
  void begin(Tree container) {
    Tree& value = place();
    value = std::move(container);
    open.push_back(&value);
  }
  void end(bool is_object) {
    SPECTRACE_CHECK(!open.empty() && open.back()->is_object() == is_object && !has_key);
    open.pop_back();
  }
};

namespace {

std::string line_text(const Tree& value) {
  // Text that is not UTF-8 (a file name may be anything) must not make a report fail.
  return value.dump(-1, ' ', false, Tree::error_handler_t::replace);
}

/// As the library's own indented form, but arrays of plain values take one line: spectra have hundreds.
void print(const Tree& value, std::size_t indent, std::string& out) {
  const auto is_plain = [](const Tree& v) { return !v.is_structured(); };
  if (is_plain(value) || value.empty()) {
    out += line_text(value);
    return;
  }
  const bool one_line = value.is_array() && std::all_of(value.begin(), value.end(), is_plain);
  const std::string line_break = one_line ? " " : "\n" + std::string(2 * indent + 2, ' ');
  out += value.is_array() ? "[" : "{";
  bool is_first = true;
  for (const auto& [key, element] : value.items()) {
    if (!is_first) out += ',';
    if (!is_first || !one_line) out += line_break;
    if (value.is_object()) out += line_text(key) + ": ";
    print(element, indent + 1, out);
    is_first = false;
  }
  if (!one_line) out += "\n" + std::string(2 * indent, ' ');
  out += value.is_array() ? "]" : "}";
}

}  // namespace

JsonWriter::JsonWriter() : impl_(std::make_unique<Impl>()) {}
JsonWriter::~JsonWriter() = default;
JsonWriter::JsonWriter(JsonWriter&&) noexcept = default;

void JsonWriter::begin_object() { impl_->begin(Tree::object()); }
void JsonWriter::end_object() { impl_->end(true); }
void JsonWriter::begin_array() { impl_->begin(Tree::array()); }
void JsonWriter::end_array() { impl_->end(false); }
void JsonWriter::key(std::string_view name) {
  SPECTRACE_CHECK(!impl_->has_key && !impl_->open.empty() && impl_->open.back()->is_object());
  impl_->key = name;
  impl_->has_key = true;
}
void JsonWriter::value(double x) { impl_->place() = x; }
void JsonWriter::value(std::int64_t x) { impl_->place() = x; }
void JsonWriter::value(bool x) { impl_->place() = x; }
void JsonWriter::value(std::string_view text) { impl_->place() = text; }
void JsonWriter::null() { impl_->place() = nullptr; }

std::string JsonWriter::line() const {
  SPECTRACE_CHECK(impl_->has_root && impl_->open.empty());
  return line_text(impl_->root) + '\n';
}

std::string JsonWriter::text() const {
  SPECTRACE_CHECK(impl_->has_root && impl_->open.empty());
  std::string out;
  print(impl_->root, 0, out);
  return out + '\n';
}

}  // namespace spectrace
