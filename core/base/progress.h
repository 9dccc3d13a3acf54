// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace spectrace {

/// What long work tells its caller. Libraries report, cli/ prints. Called from any thread.
class Progress {
 public:
  virtual ~Progress() = default;
  /// `done` of `total` units of `stage` are finished; `total` > 0, infinite where nobody knows.
  virtual void update(std::string_view stage, double done, double total) = 0;
  /// A fact worth one line: an effect skipped, a table extrapolated. `text` has no newline.
  virtual void note(std::string_view text) = 0;
};

/// Says nothing.
class SilentProgress final : public Progress {
 public:
  void update(std::string_view, double, double) override {}
  void note(std::string_view) override {}
};

}  // namespace spectrace
