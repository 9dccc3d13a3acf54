// SPDX-License-Identifier: Apache-2.0
// The program's frame: builds the command line, runs what it names, turns every outcome into an exit code.
#include <fmt/core.h>

#include <cstdio>
#include <exception>
#include <new>
#include <system_error>

#include "cli/command.h"
#include "core/base/error.h"
#include "core/base/version.h"

namespace spectrace::cli {
namespace {

constexpr const char* kExamples =
    "Examples:\n"
    "  spectrace scenes/cornell_box.json -o box.exr --spp 256\n"
    "  spectrace scenes/cornell_box.json -o box.exr --spp 4096 --checkpoint 60 --resume\n"
    "  spectrace scenes/material_ball.json --separate diffraction -o ball.exr\n"
    "  spectrace acquire scenes/materials/pearlescent.json -o pearlescent.bsdf\n"
    "  spectrace separate pearlescent.bsdf -o pearlescent.sep\n"
    "  spectrace compare reference.exr test.exr --max relmse=1e-3 --min ssim=0.99\n"
    "  spectrace inspect pearlescent.bsdf\n"
    "  spectrace reproduce epfl_rgb -o report\n"
    "  spectrace bench scenes/cornell_box.json\n"
    "  spectrace cost scenes/cornell_box.json -o report\n"
    "\n"
    "Exit codes: 0 success, 1 images differ or a fit is unusable, 2 usage, 3 bad input, 4 internal error,\n"
    "5 interrupted.";

ExitCode run(int argc, const char* const* argv) {
  CLI::App app{"Spectral path tracing, with separation of measured BRDFs into diffuse and specular.",
               "spectrace"};
  app.set_version_flag("--version", fmt::format("spectrace {} ({})", version(), commit()));
  app.footer(kExamples);
  app.require_subcommand(0, 1);
  Action chosen;
  add_render(app, chosen);
  add_merge(app, chosen);
  add_separate(app, chosen);
  add_compare(app, chosen);
  add_inspect(app, chosen);
  add_acquire(app, chosen);
  add_reproduce(app, chosen);
  add_sheet(app, chosen);
  add_bench(app, chosen);
  add_cost(app, chosen);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    // --help and --version arrive here as well, with exit code 0.
    return app.exit(e) == 0 ? ExitCode::kSuccess : ExitCode::kUsage;
  }
  if (!chosen) {  // nothing was asked for
    fmt::print(stderr, "{}", app.help());
    return ExitCode::kUsage;
  }
  return chosen();
}

}  // namespace
}  // namespace spectrace::cli

int main(int argc, char** argv) {
  using spectrace::cli::ExitCode;
  ExitCode code = ExitCode::kInternal;
  try {
    code = spectrace::cli::run(argc, argv);
    // An earlier, partial flush may have failed already: only the stream's own mark tells.
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
      throw spectrace::InputError("standard output", "", "cannot be written");
    }
  } catch (const spectrace::InputError& e) {
    for (const spectrace::Diagnostic& diagnostic : e.diagnostics()) {
      fmt::print(stderr, "{}\n", diagnostic.text());
    }
    code = ExitCode::kBadInput;
  } catch (const std::system_error& e) {
    // What the system refuses (a full disk, a closed pipe) is the world's doing, not a fault of the program.
    fmt::print(stderr, "{}\n", e.what());
    code = ExitCode::kBadInput;
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "internal error: out of memory\n");
    code = ExitCode::kInternal;
  } catch (const std::exception& e) {
    fmt::print(stderr, "internal error: {}\n", e.what());
    code = ExitCode::kInternal;
  } catch (...) {
    fmt::print(stderr, "internal error: unknown exception\n");
    code = ExitCode::kInternal;
  }
  return static_cast<int>(code);
}
