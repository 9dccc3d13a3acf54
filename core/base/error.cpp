// SPDX-License-Identifier: Apache-2.0
#include "core/base/error.h"

#include <fmt/format.h>

#include <utility>

namespace spectrace {

namespace {

std::string join_lines(const std::vector<Diagnostic>& diagnostics) {
  SPECTRACE_CHECK(!diagnostics.empty());
  std::string text;
  for (const Diagnostic& d : diagnostics) {
    if (!text.empty()) text += '\n';
    text += d.text();
  }
  return text;
}

/// Bytes of a part of a message; beyond it a damaged file is quoted, of which its two ends are enough.
constexpr std::size_t kLongestPart = 500, kHead = 300, kTail = 150;

std::string shortened(const std::string& text) {
  if (text.size() <= kLongestPart) return text;
  const auto is_inside_character = [&](std::size_t i) {
    return (static_cast<unsigned char>(text[i]) & 0xc0U) == 0x80;  // a continuation byte of UTF-8
  };
  std::size_t head = kHead, tail = text.size() - kTail;
  while (head > kHead - 4 && is_inside_character(head)) --head;
  while (tail < text.size() - kTail + 4 && is_inside_character(tail)) ++tail;
  return fmt::format("{} ... ({} bytes) ... {}", text.substr(0, head), tail - head, text.substr(tail));
}

}  // namespace

std::string Diagnostic::text() const {
  const std::string what = shortened(problem);
  std::string line = where.empty() ? fmt::format("{}: {}", file, what)
                                   : fmt::format("{}:{}: {}", file, shortened(where), what);
  // One diagnostic, one line, whatever a hostile file has put into a name that we quote.
  for (char& c : line) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  }
  return line;
}

InputError::InputError(std::string file, std::string where, std::string problem)
    : InputError(std::vector<Diagnostic>{{std::move(file), std::move(where), std::move(problem)}}) {}

InputError::InputError(std::vector<Diagnostic> diagnostics)
    : std::runtime_error(join_lines(diagnostics)), diagnostics_(std::move(diagnostics)) {}

void check_failed(const char* expression, const char* file, int line) {
  throw InternalError(fmt::format("{}:{}: check failed: {}", file, line, expression));
}

}  // namespace spectrace
