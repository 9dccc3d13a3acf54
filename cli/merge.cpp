// SPDX-License-Identifier: Apache-2.0
// `spectrace merge A.partial B.partial ... -o OUT.exr`: parts of one image become the whole.
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "cli/command.h"
#include "cli/output.h"
#include "cli/render_output.h"
#include "core/base/error.h"
#include "renderer/partial_render.h"

namespace spectrace::cli {

namespace {

namespace fs = std::filesystem;

constexpr const char* kNotes =
    "Example:\n"
    "  spectrace scene.json -o a.exr --samples 0:512\n"
    "  spectrace scene.json -o b.exr --samples 512:1024\n"
    "  spectrace merge a.partial b.partial -o scene.exr\n"
    "\n"
    "The image has the bits that one machine gives, in whatever order the parts are named. Parts must be of "
    "one\n"
    "scene, seed, sampler, build and set of AOVs, complete, without overlap or gap. With -o OUT.partial the "
    "whole is\n"
    "written as a part again.";

struct Arguments {
  std::vector<std::string> parts;
  RenderOutput output;
};

ExitCode merge_command(const Arguments& arguments) {
  require_folder_of(arguments.output.file);
  PartialRender merged = merge_partials({arguments.parts.begin(), arguments.parts.end()});
  const SampleRange samples = merged.film.target();
  merged.metadata["spectrace:spp"] = std::int64_t(samples.count());
  merged.metadata["spectrace:sampleRange"] = fmt::format("{}:{}", samples.first, samples.last);
  merged.metadata["spectrace:invalidSamples"] = std::int64_t(merged.film.invalid_samples());
  if (arguments.output.file.extension() == ".partial") {
    write_partial(arguments.output.file, merged);
  } else {
    // A part of a render may be looked at; a merge that begins late has lost its first part.
    if (samples.first != 0) {
      throw InputError(
          arguments.output.file.string(), "",
          fmt::format("would begin with sample {}: the parts before are missing; to join some of them, name "
                      "the output .partial",
                      samples.first));
    }
    write_images(arguments.output, merged.film, merged.metadata);
  }
  fmt::print("{}: samples {}:{} of {} parts\n", arguments.output.file.string(), samples.first, samples.last,
             arguments.parts.size());
  return ExitCode::kSuccess;
}

}  // namespace

void add_merge(CLI::App& app, Action& chosen) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand("merge", "join renders of ranges of samples to one image");
  command->add_option("parts", arguments->parts, "files written by --samples or --checkpoint (.partial)")
      ->required();
  command->add_option("-o,--output", arguments->output.file, "image (.exr) or part (.partial) to write")
      ->required();
  command->footer(kNotes);
  command->callback([&chosen, arguments] {
    const std::string ending = arguments->output.file.extension().string();
    if (ending != ".exr" && ending != ".partial") {
      throw CLI::ValidationError("--output", "must end in .exr or .partial");
    }
    chosen = [arguments] { return merge_command(*arguments); };
  });
}

}  // namespace spectrace::cli
