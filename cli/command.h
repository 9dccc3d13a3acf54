// SPDX-License-Identifier: Apache-2.0
// One file a subcommand: each adds its options and, when the command line names it, becomes the work to do.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace spectrace::cli {

enum class ExitCode : int {
  kSuccess = 0,
  kDiffers = 1,   ///< images differ, or a fit is unusable
  kUsage = 2,     ///< the command line itself
  kBadInput = 3,  ///< InputError
  kInternal = 4,
  kInterrupted = 5,  ///< by SIGINT or SIGTERM; what there was is written
};

using Action = std::function<ExitCode()>;

/// Each adds to `app`; parsing the command line sets `chosen`.
void add_render(CLI::App& app, Action& chosen);  ///< the main command: `spectrace SCENE.json`
void add_merge(CLI::App& app, Action& chosen);   ///< parts of one image
void add_separate(CLI::App& app, Action& chosen);
void add_compare(CLI::App& app, Action& chosen);
void add_inspect(CLI::App& app, Action& chosen);
void add_acquire(CLI::App& app, Action& chosen);
void add_reproduce(CLI::App& app, Action& chosen);  ///< the paper's tables and figures
void add_sheet(CLI::App& app, Action& chosen);      ///< contact sheet of images
void add_bench(CLI::App& app, Action& chosen);      ///< speed of a scene
void add_cost(CLI::App& app, Action& chosen);       ///< what accuracy costs in time

}  // namespace spectrace::cli
