// SPDX-License-Identifier: Apache-2.0
// Progress on standard error: a line with percent and time left that rewrites itself on a terminal, a plain
// line now and then elsewhere; notes always.
#pragma once

#include <chrono>
#include <mutex>
#include <string>

#include "core/base/progress.h"

namespace spectrace::cli {

class ConsoleProgress final : public Progress {
 public:
  ConsoleProgress();
  ~ConsoleProgress() override;  ///< clears the line
  ConsoleProgress(const ConsoleProgress&) = delete;
  ConsoleProgress& operator=(const ConsoleProgress&) = delete;

  void update(std::string_view stage, double done, double total) override;
  void note(std::string_view text) override;
  void finish();  ///< clears the line, before results are printed

 private:
  using Clock = std::chrono::steady_clock;
  void clear_line();

  std::mutex mutex_;
  bool is_terminal_;
  bool line_shown_ = false;
  std::string stage_;
  Clock::time_point stage_start_, last_shown_;
};

}  // namespace spectrace::cli
