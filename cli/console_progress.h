// SPDX-License-Identifier: Apache-2.0
// Progress on standard error: a line with percent and time left that rewrites itself on a terminal, a plain
// line now and then elsewhere, or lines of JSON for programs; notes always.
#pragma once

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <string>

#include "core/base/progress.h"

namespace spectrace::cli {

enum class ProgressStyle : std::uint8_t {
  kAuto,   ///< a line that rewrites itself on a terminal, else as kPlain
  kPlain,  ///< a line every ten seconds
  kJson,   ///< {"stage", "done", "total", "elapsed_s", "remaining_s"} once a second, {"note"}; one a line
};

class ConsoleProgress final : public Progress {
 public:
  explicit ConsoleProgress(ProgressStyle style = ProgressStyle::kAuto);
  ~ConsoleProgress() override;  ///< clears the line
  ConsoleProgress(const ConsoleProgress&) = delete;
  ConsoleProgress& operator=(const ConsoleProgress&) = delete;

  void update(std::string_view stage, double done, double total) override;
  void note(std::string_view text) override;
  void finish();  ///< clears the line, before results are printed

 private:
  using Clock = std::chrono::steady_clock;
  enum class Form : std::uint8_t { kTerminal, kLines, kJson };
  [[nodiscard]] bool is_due(Clock::time_point now, bool is_done) const;
  void clear_line();

  std::mutex mutex_;
  Form form_;
  bool line_shown_ = false;
  std::string stage_;
  Clock::time_point stage_start_, last_shown_;
  double first_done_ = 0;  // at the start: a resumed render begins in its middle
};

/// `--progress auto|plain|json`.
void add_progress_option(CLI::App& command, ProgressStyle& style);

}  // namespace spectrace::cli
