// SPDX-License-Identifier: Apache-2.0
// The three kinds of trouble (docs/conventions.md): bad input throws InputError, the outcome of a
// computation is a value, a programmer's error fails a check.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace spectrace {

/// One thing wrong with one input file.
struct Diagnostic {
  std::string file;     ///< as the user named it
  std::string where;    ///< "41:18: /materials/2/roughness", "byte 812: field \"vndf\"", or empty
  std::string problem;  ///< what was expected and what was found

  /// `file:where: problem`, in one line, however long what a damaged file has put into it.
  [[nodiscard]] std::string text() const;
};

/// Bad input: thrown anywhere, caught only in cli/main.cpp, which prints one line a diagnostic and exits 3.
class InputError : public std::runtime_error {
 public:
  InputError(std::string file, std::string where, std::string problem);
  explicit InputError(std::vector<Diagnostic> diagnostics);  ///< at least one

  [[nodiscard]] const std::vector<Diagnostic>& diagnostics() const { return diagnostics_; }

 private:
  std::vector<Diagnostic> diagnostics_;
};

/// A broken promise inside the program; exit code 4.
class InternalError : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

[[noreturn]] void check_failed(const char* expression, const char* file, int line);

}  // namespace spectrace

/// Programmer's error, cold code: always on.
#define SPECTRACE_CHECK(expression) \
  ((expression) ? static_cast<void>(0) : ::spectrace::check_failed(#expression, __FILE__, __LINE__))

/// Programmer's error, hot code: debug and sanitizer builds only.
#ifdef NDEBUG
#define SPECTRACE_DCHECK(expression) static_cast<void>(0)
#else
#define SPECTRACE_DCHECK(expression) SPECTRACE_CHECK(expression)
#endif
