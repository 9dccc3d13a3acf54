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

}  // namespace

std::string Diagnostic::text() const {
  std::string line =
      where.empty() ? fmt::format("{}: {}", file, problem) : fmt::format("{}:{}: {}", file, where, problem);
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
