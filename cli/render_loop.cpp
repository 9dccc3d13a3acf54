// SPDX-License-Identifier: Apache-2.0
#include "cli/render_loop.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <vector>

namespace spectrace::cli {

namespace {

using Clock = RenderSession::Clock;

std::atomic<bool> stop_asked{false};
static_assert(std::atomic<bool>::is_always_lock_free, "set from a signal handler");

extern "C" void ask_to_stop(int signal) {
  stop_asked = true;
  std::signal(signal, SIG_DFL);  // the next one is not to be caught
}

Clock::duration seconds(double s) {
  return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(s));
}

}  // namespace

SignalWatch::SignalWatch()
    : interrupt_(std::signal(SIGINT, ask_to_stop)), terminate_(std::signal(SIGTERM, ask_to_stop)) {}

SignalWatch::~SignalWatch() {
  std::signal(SIGINT, interrupt_);
  std::signal(SIGTERM, terminate_);
}

bool run(RenderSession& session, const std::vector<Recurring>& tasks, Progress& progress) {
  std::vector<Clock::time_point> due;
  for (const Recurring& task : tasks) due.push_back(Clock::now() + seconds(task.every_seconds));
  for (;;) {
    const auto next = due.empty() ? Clock::time_point::max() : *std::min_element(due.begin(), due.end());
    const bool is_done = session.advance(next, stop_asked, progress);
    if (is_done || stop_asked) return is_done;
    for (std::size_t i = 0; i < tasks.size(); ++i) {
      if (Clock::now() < due[i]) continue;
      tasks[i].action();
      due[i] = Clock::now() + seconds(tasks[i].every_seconds);
    }
  }
}

}  // namespace spectrace::cli
