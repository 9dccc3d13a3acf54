// SPDX-License-Identifier: Apache-2.0
// `spectrace cost SCENE.json -o REPORT`
#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <string>

#include "cli/command.h"
#include "cli/console_progress.h"
#include "cli/cost/answers.h"
#include "cli/cost/measurement.h"
#include "cli/cost/report.h"
#include "cli/grid_option.h"
#include "cli/option_values.h"

namespace spectrace::cli {

namespace {

constexpr const char* kNotes =
    "Renders a reference of the scene as it is, then ladders of samples for every way to render it faster: "
    "poorer\n"
    "separated models, shorter paths, fewer wavelengths, without each effect that it uses; splits each error "
    "into\n"
    "noise and bias; writes index.html, cost.json, cost.csv and plots. Close other programs first: times are "
    "wall-clock.";

struct Arguments {
  std::string scene, output;
  CostOptions options;
  SceneSeparation separation;
  ProgressStyle progress = ProgressStyle::kAuto;
};

ExitCode cost_command(const Arguments& arguments) {
  ConsoleProgress progress(arguments.progress);
  SceneDesc scene = load_scene(arguments.scene);
  settle_models(scene, progress);
  make_report_folder(arguments.output);
  const CostStudy study =
      measure_cost(scene, settings_of(scene, arguments.separation), arguments.options, progress);
  write_cost_report(arguments.output, study);
  progress.finish();
  fmt::print("{:<28}{:>10}{:>14}{:>12}{:>12}\n", "setting", "samples", "s", "noise [%]", "bias [%]");
  for (const CostRecord& record : study.records) {
    const int spp = record.points.back().spp;
    const double noise = std::sqrt(record.model.rel_mse(spp) - record.model.bias);
    fmt::print("{:<28}{:>10}{:>14.4g}{:>12.2g}{:>12}\n", record.title, spp, record.model.seconds(spp),
               100 * noise, bias_text(record.bias));
  }
  for (const std::string& reason : study.left_out) fmt::print("left out: {}\n", reason);
  fmt::print("{}/index.html\n", arguments.output);
  return ExitCode::kSuccess;
}

}  // namespace

void add_cost(CLI::App& app, Action& chosen) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand("cost", "measure what accuracy costs in time, for this scene");
  command->add_option("scene", arguments->scene, "scene to render (.json)")->required();
  command->add_option("-o,--output", arguments->output, "folder of the report")->required();
  command->add_option("--budget", arguments->options.budget_seconds, "seconds to take")
      ->check(seconds_above_zero())
      ->capture_default_str();
  command->add_option("--reference", arguments->options.reference,
                      "picture (.exr) to take for the truth, instead of rendering one; must have R, G, B");
  command->add_option("--threads", arguments->options.threads, "0 = all cores")
      ->check(CLI::Range(0, 4096))
      ->capture_default_str();
  add_grid_option(*command, arguments->separation.grid);
  command->add_option("--cache", arguments->separation.cache,
                      "folder that keeps separated materials; default: ~/.cache/spectrace");
  add_progress_option(*command, arguments->progress);
  command->footer(kNotes);
  command->callback([&chosen, arguments] { chosen = [arguments] { return cost_command(*arguments); }; });
}

}  // namespace spectrace::cli
