// SPDX-License-Identifier: Apache-2.0
// A render under way: checkpoints, pictures to look at, and an end when a signal asks for it.
#pragma once

#include <functional>

#include "core/base/progress.h"
#include "renderer/render.h"

namespace spectrace::cli {

/// Something to be done from time to time.
struct Recurring {
  double every_seconds = 0;
  std::function<void()> action;
};

/// Signals ask for an end while this lives, instead of ending the program: from the first sample to the last
/// file written. A second signal ends the program at once.
class SignalWatch {
 public:
  SignalWatch();
  ~SignalWatch();
  SignalWatch(const SignalWatch&) = delete;
  SignalWatch& operator=(const SignalWatch&) = delete;

 private:
  using Handler = void (*)(int);
  Handler interrupt_, terminate_;
};

/// Renders until all is done or SIGINT or SIGTERM comes, under a SignalWatch. True: done.
bool run(RenderSession& session, const std::vector<Recurring>& tasks, Progress& progress);

}  // namespace spectrace::cli
