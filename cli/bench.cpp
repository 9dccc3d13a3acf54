// SPDX-License-Identifier: Apache-2.0
// `spectrace bench SCENE.json`
#include <fmt/format.h>

#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "cli/aovs_option.h"
#include "cli/command.h"
#include "cli/console_progress.h"
#include "cli/inspect_report.h"
#include "cli/output.h"
#include "core/base/file.h"
#include "core/base/version.h"
#include "renderer/throughput.h"

namespace spectrace::cli {

namespace {

constexpr const char* kNotes =
    "Renders the scene on one thread and on --threads, then traces the rays of some of its paths again by "
    "themselves,\n"
    "in the packets they came in and one at a time. \"raw\" is the faster of the two: what Embree alone does "
    "with these rays.\n"
    "Close other programs first: all figures are wall-clock time.";

struct Arguments {
  std::string scene, json;
  std::optional<int> spp;
  int threads = 0;
  std::optional<AovSet> aovs;
  ProgressStyle progress = ProgressStyle::kAuto;
};

/// As Linux names it; empty where it does not say.
std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const std::size_t colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "";
}

InspectReport report_of(const Arguments& arguments, const Throughput& t) {
  InspectSection machine;
  machine.title = "machine";
  machine.add("processor", processor());
  machine.add("hardware_threads", static_cast<std::int64_t>(std::thread::hardware_concurrency()));
  machine.add("spectrace", fmt::format("{} ({})", version(), commit()));
  InspectSection render;
  render.title = "render";
  render.add("scene", arguments.scene);
  render.add("kernel", t.kernel);
  render.add("triangles", static_cast<std::int64_t>(t.triangles));
  render.add("paths", static_cast<std::int64_t>(t.paths));
  render.add("rays_per_path", double(t.rays) / double(t.paths));
  render.add("seconds_one_thread", t.seconds);
  render.add("million_paths_per_second", double(t.paths) / t.seconds * 1e-6);
  render.add("million_rays_per_second", t.rays_per_second() * 1e-6);
  render.add("threads", t.threads);
  render.add("seconds_threads", t.seconds_of_threads);
  render.add("speedup_of_threads", t.seconds / t.seconds_of_threads);
  render.add("peak_memory_mb", double(t.peak_memory_bytes) * 1e-6);
  InspectSection embree;
  embree.title = "embree_alone";
  embree.add("packets_million_rays_per_second", double(t.rays) / t.traversal * 1e-6);
  embree.add("single_million_rays_per_second", t.single_rays_per_second * 1e-6);
  embree.add("render_over_raw", t.rays_per_second() / t.raw_rays_per_second());
  InspectSection split;
  split.title = "time_of_one_thread";
  split.columns = {"part", "seconds", "share"};
  const auto part = [&](const char* name, double seconds) {
    split.rows.push_back({std::string(name), seconds, seconds / t.seconds});
  };
  part("traversal", t.traversal);
  part("sampling", t.sampling);
  part("film", t.film);
  part("shading", t.shading());
  return {machine, render, embree, split};
}

ExitCode bench_command(const Arguments& arguments) {
  ConsoleProgress progress(arguments.progress);
  if (!arguments.json.empty()) require_folder_of(arguments.json);
  const Scene scene = build_scene(load_scene(arguments.scene), progress);
  const Throughput measured = measure_throughput(scene,
                                                 {.spp = arguments.spp.value_or(scene.spp),
                                                  .threads = arguments.threads,
                                                  .aovs = arguments.aovs.value_or(kNoAovs)},
                                                 progress);
  progress.finish();
  const InspectReport report = report_of(arguments, measured);
  fmt::print("{}", to_text(report));
  if (!arguments.json.empty()) write_file_atomically(arguments.json, to_json(report));
  return ExitCode::kSuccess;
}

}  // namespace

void add_bench(CLI::App& app, Action& chosen) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand("bench", "measure how fast a scene renders and where the time goes");
  command->add_option("scene", arguments->scene, "scene to render (.json)")->required();
  command->add_option("--spp", arguments->spp, "samples a pixel; default: the scene's")
      ->check(CLI::Range(1, 1 << 30));
  command->add_option("--threads", arguments->threads, "of the second render; 0 = all cores")
      ->check(CLI::Range(0, 4096))
      ->capture_default_str();
  add_aovs_option(*command, arguments->aovs, "none");
  command->add_option("--json", arguments->json, "also write the figures to this file");
  add_progress_option(*command, arguments->progress);
  command->footer(kNotes);
  command->callback([&chosen, arguments] { chosen = [arguments] { return bench_command(*arguments); }; });
}

}  // namespace spectrace::cli
