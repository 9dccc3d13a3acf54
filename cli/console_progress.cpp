// SPDX-License-Identifier: Apache-2.0
#include "cli/console_progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

namespace spectrace::cli {

namespace {
constexpr std::chrono::milliseconds kRefresh{100};  // faster than the eye follows costs terminals time
constexpr std::chrono::seconds kLogRefresh{10};     // a log of an hour's work stays short enough to read
}  // namespace

ConsoleProgress::ConsoleProgress() : is_terminal_(isatty(STDERR_FILENO) == 1) {}

ConsoleProgress::~ConsoleProgress() { clear_line(); }

void ConsoleProgress::finish() {
  const std::lock_guard lock(mutex_);
  clear_line();
}

void ConsoleProgress::update(std::string_view stage, double done, double total) {
  const std::lock_guard lock(mutex_);
  const Clock::time_point now = Clock::now();
  if (stage != stage_) {
    stage_ = stage;
    stage_start_ = now;
    if (!is_terminal_) last_shown_ = now;  // work shorter than the interval leaves no line
  }
  if (now - last_shown_ < (is_terminal_ ? Clock::duration(kRefresh) : Clock::duration(kLogRefresh))) {
    return;
  }
  last_shown_ = now;
  const double share = done / total;
  const double elapsed_s = std::chrono::duration<double>(now - stage_start_).count();
  const std::string left =
      share > 0 ? fmt::format("{:.0f} s left", elapsed_s / share * (1 - share)) : std::string();
  if (is_terminal_) {
    fmt::print(stderr, "\r\033[K{} {:3.0f} %  {}", stage_, 100 * share, left);
    line_shown_ = true;
  } else {
    fmt::print(stderr, "{} {:.0f} %  {}\n", stage_, 100 * share, left);
  }
  std::fflush(stderr);
}

void ConsoleProgress::note(std::string_view text) {
  const std::lock_guard lock(mutex_);
  clear_line();
  fmt::print(stderr, "{}\n", text);
}

void ConsoleProgress::clear_line() {
  if (line_shown_) fmt::print(stderr, "\r\033[K");
  line_shown_ = false;
}

}  // namespace spectrace::cli
