// SPDX-License-Identifier: Apache-2.0
#include "cli/console_progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <limits>
#include <map>

#include "cli/option_values.h"
#include "core/base/json.h"

namespace spectrace::cli {

namespace {

constexpr std::chrono::milliseconds kRefresh{100};       // faster than the eye follows costs terminals time
constexpr std::chrono::milliseconds kLogRefresh{10000};  // a log of an hour's work stays short enough to read
constexpr std::chrono::milliseconds kJsonRefresh{1000};  // a program that shows a bar wants no more

/// NaN where nothing tells.
double seconds_left(double done_since, double to_do, double elapsed_s) {
  if (to_do <= 0) return 0;
  const bool is_known = done_since > 0 && std::isfinite(to_do);
  return is_known ? elapsed_s / done_since * to_do : std::numeric_limits<double>::quiet_NaN();
}

std::string json_progress(std::string_view stage, double done, double total, double elapsed_s,
                          double remaining_s) {
  JsonWriter json;
  json.begin_object();
  json.member("stage", stage);
  json.member("done", done);
  json.member("total", total);
  json.member("elapsed_s", elapsed_s);
  json.member("remaining_s", remaining_s);
  json.end_object();
  return json.line();
}

std::string json_note(std::string_view text) {
  JsonWriter json;
  json.begin_object();
  json.member("note", text);
  json.end_object();
  return json.line();
}

}  // namespace

ConsoleProgress::ConsoleProgress(ProgressStyle style)
    : form_(style == ProgressStyle::kJson                                 ? Form::kJson
            : style == ProgressStyle::kAuto && isatty(STDERR_FILENO) == 1 ? Form::kTerminal
                                                                          : Form::kLines) {}

ConsoleProgress::~ConsoleProgress() { clear_line(); }

void ConsoleProgress::finish() {
  const std::lock_guard lock(mutex_);
  clear_line();
}

bool ConsoleProgress::is_due(Clock::time_point now, bool is_done) const {
  switch (form_) {
    case Form::kTerminal:
      return now - last_shown_ >= kRefresh;
    case Form::kLines:
      return now - last_shown_ >= kLogRefresh;
    case Form::kJson:
      // A program is told of each end, so that its bar does not stop short.
      return is_done || now - last_shown_ >= kJsonRefresh;
  }
  return false;
}

void ConsoleProgress::update(std::string_view stage, double done, double total) {
  const std::lock_guard lock(mutex_);
  const Clock::time_point now = Clock::now();
  if (stage != stage_) {
    stage_ = stage;
    stage_start_ = now;
    first_done_ = done;
    if (form_ == Form::kLines) last_shown_ = now;  // work shorter than the interval leaves no line
  }
  if (!is_due(now, done >= total)) return;
  last_shown_ = now;
  const double share = done / total;
  const double elapsed_s = std::chrono::duration<double>(now - stage_start_).count();
  const double left_s = seconds_left(done - first_done_, total - done, elapsed_s);
  if (form_ == Form::kJson) {
    fmt::print(stderr, "{}", json_progress(stage_, done, total, elapsed_s, left_s));
  } else {
    const std::string left = std::isnan(left_s) ? std::string() : fmt::format("{:.0f} s left", left_s);
    if (form_ == Form::kTerminal) {
      fmt::print(stderr, "\r\033[K{} {:3.0f} %  {}", stage_, 100 * share, left);
      line_shown_ = true;
    } else {
      fmt::print(stderr, "{} {:.0f} %  {}\n", stage_, 100 * share, left);
    }
  }
  std::fflush(stderr);
}

void ConsoleProgress::note(std::string_view text) {
  const std::lock_guard lock(mutex_);
  clear_line();
  if (form_ == Form::kJson) {
    fmt::print(stderr, "{}", json_note(text));
  } else {
    fmt::print(stderr, "{}\n", text);
  }
}

void ConsoleProgress::clear_line() {
  if (line_shown_) fmt::print(stderr, "\r\033[K");
  line_shown_ = false;
}

void add_progress_option(CLI::App& command, ProgressStyle& style) {
  const std::map<std::string, ProgressStyle> styles{
      {"auto", ProgressStyle::kAuto}, {"plain", ProgressStyle::kPlain}, {"json", ProgressStyle::kJson}};
  take_one_of(
      command.add_option(
          "--progress", style,
          "on standard error: auto (a line that rewrites itself on a terminal, else plain), plain, json "
          "(a line a second: stage, done, total, elapsed_s, remaining_s)"),
      styles);
}

}  // namespace spectrace::cli
