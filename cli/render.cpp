// SPDX-License-Identifier: Apache-2.0
// `spectrace SCENE.json [-o OUT.exr]`: the main command.
#include "renderer/render.h"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/command.h"
#include "cli/console_progress.h"
#include "cli/grid_option.h"
#include "cli/output.h"
#include "cli/separation_cache.h"
#include "core/base/error.h"
#include "core/image/texture_cache.h"
#include "separation/choose_model.h"

namespace spectrace::cli {

namespace {

namespace fs = std::filesystem;

struct Arguments {
  std::string scene, output;
  std::optional<int> spp;
  std::optional<std::uint64_t> seed;
  int threads = 0;
  std::string separate;  // a model's name, "auto", or empty
  double tolerance = kDefaultTolerance;
  HalfDifferenceGrid grid;
  bool paired = false;
  std::string cache;
  bool strict = false;
  bool layer_pngs = false;
  bool beauty_only = false;
  double exposure = 1;
  ProgressStyle progress = ProgressStyle::kAuto;
  std::size_t texture_cache = kTextureCacheMiB;
};

/// Where separated materials wait for the next run: the user's cache (XDG Base Directory Specification).
fs::path default_cache() {
  const auto variable = [](const char* name) {
    const char* value = std::getenv(name);  // NOLINT(concurrency-mt-unsafe): before any thread starts
    return std::string(value == nullptr ? "" : value);
  };
  if (const std::string cache = variable("XDG_CACHE_HOME"); !cache.empty()) {
    return fs::path(cache) / "spectrace";
  }
  const std::string home = variable("HOME");
  return (home.empty() ? fs::temp_directory_path() : fs::path(home) / ".cache") / "spectrace";
}

fs::path output_file(const Arguments& arguments) {
  const std::string model = arguments.separate.empty() ? "" : "-" + arguments.separate;
  const fs::path file = arguments.output.empty() ? fs::path(arguments.scene).stem().concat(model + ".exr")
                                                 : fs::path(arguments.output);
  require_folder_of(file);
  return file;
}

/// Every measured material becomes its separated form, or with --paired alone draws its directions. False,
/// with the reason noted, where one cannot.
bool separate_materials(SceneDesc& scene, const Arguments& arguments, Progress& progress) {
  const fs::path cache = arguments.cache.empty() ? default_cache() : fs::path(arguments.cache);
  const std::optional<SeparationModel> model = separation_model_named(arguments.separate);  // none: auto
  SeparationOptions options;
  options.grid = arguments.grid;
  options.threads = arguments.threads;
  const bool may_need_residual = arguments.separate == "auto" || model == SeparationModel::kResidual;
  options.residual_rank = may_need_residual ? kDefaultResidualRank : 0;
  std::size_t count = 0;
  std::vector<MaterialDesc*> materials;
  for (MaterialDesc& whole : scene.materials) {
    for_each_desc(whole, [&](MaterialDesc& part) {
      if (part.name.empty()) part.name = whole.name;  // for messages
      materials.push_back(&part);
    });
  }
  for (MaterialDesc* const each : materials) {
    MaterialDesc& material = *each;
    if (const auto* measured = std::get_if<MeasuredDesc>(&material.kind)) {
      const CachedSeparation separated = cached_separation(measured->file, cache, options, progress);
      if (!separated.report.usable) {
        progress.note(fmt::format("{}: {}", measured->file.string(), separated.report.verdict));
        return false;
      }
      progress.note(fmt::format("{}: {} {}{}", material.name,
                                separated.was_cached ? "separated before," : "separated into",
                                separated.file.string(),
                                arguments.separate.empty() ? ", which draws its directions (--paired)" : ""));
      const fs::path directions = arguments.paired ? separated.file : fs::path();
      ++count;
      if (arguments.separate.empty()) {
        material.kind = MeasuredDesc{measured->file, directions};
        continue;
      }
      SeparatedDesc description{.file = separated.file, .model = model, .directions = directions};
      if (!model) {
        const ModelChoice choice = choose_model(MeasuredBrdf(read_measured(measured->file)),
                                                read_separated_source(separated.file), arguments.tolerance);
        progress.note(fmt::format("{}: model {}", material.name, choice.reason));
        description.model = choice.model;
      }
      material.kind = description;
    }
  }
  if (count == 0) {
    progress.note(fmt::format("{}: no measured material to separate", scene.file_name));
  }
  return true;
}

void print_summary(const fs::path& file, const RenderOptions& options, const RenderResult& result) {
  const RenderReport& report = result.report;
  fmt::print(
      "{}: {} x {}, {} samples a pixel, {:.2f} s on {} threads, {:.3g} million paths/s, {} invalid samples\n",
      file.string(), result.image.width, result.image.height, options.spp, report.seconds, report.threads,
      double(report.paths) / report.seconds * 1e-6, report.invalid_samples);
  if (report.extrapolated_share > 0) {
    fmt::print("extrapolated: {:.2g} % of the measured values seen lie beyond the last measured elevation\n",
               100 * report.extrapolated_share);
  }
  fmt::print("kernel: {}\neffects: {}\n", report.kernel, fmt::join(report.effects_used, ", "));
  fmt::print("not simulated: {}\n", fmt::join(report.effects_skipped, "; "));
}

void write_images(const fs::path& file, const Image& image, const Metadata& metadata,
                  const Arguments& arguments) {
  write_exr(file, image, metadata);
  const auto beside = [&](const std::string& suffix) {
    return fs::path(file).replace_extension().concat(suffix + ".png");
  };
  write_png(beside(""), image, "", arguments.exposure);
  if (arguments.layer_pngs && !arguments.beauty_only) {
    for (const char* layer : {"diffuse", "specular"}) {
      write_png(beside(std::string("-") + layer), image, layer, arguments.exposure);
    }
  }
}

ExitCode render_command(const Arguments& arguments) {
  ConsoleProgress progress(arguments.progress);
  const fs::path file = output_file(arguments);
  set_texture_cache_limit(arguments.texture_cache);
  SceneDesc description = load_scene(arguments.scene);
  if ((!arguments.separate.empty() || arguments.paired) &&
      !separate_materials(description, arguments, progress)) {
    return ExitCode::kDiffers;
  }
  // Roulette follows the throughput: with it paths of different materials would part.
  if (arguments.paired) description.integrator.roulette_depth = description.integrator.max_depth;
  const Scene scene = build_scene(description, progress);
  const RenderOptions options{.spp = arguments.spp.value_or(scene.spp),
                              .seed = arguments.seed.value_or(scene.seed),
                              .threads = arguments.threads,
                              .layers = !arguments.beauty_only};
  const RenderResult result = render(scene, options, progress);
  Metadata metadata = provenance(scene, options, result.report);
  if (!arguments.separate.empty()) {
    metadata["spectrace:separation"] = arguments.separate;
  }
  metadata["spectrace:paired"] = std::int64_t(arguments.paired);
  write_images(file, result.image, metadata, arguments);
  progress.finish();
  print_summary(file, options, result);
  return arguments.strict && result.report.invalid_samples > 0 ? ExitCode::kDiffers : ExitCode::kSuccess;
}

}  // namespace

void add_render(CLI::App& app, Action& chosen) {
  const auto arguments = std::make_shared<Arguments>();
  app.add_option("scene", arguments->scene, "scene to render (.json)");
  app.add_option("-o,--output", arguments->output,
                 "image to write (.exr), a .png beside it; default: the scene's name, and the model's of "
                 "--separate, in the current folder");
  app.add_option("--spp", arguments->spp, "samples a pixel; default: the scene's")
      ->check(CLI::Range(1, 1 << 30));
  app.add_option("--seed", arguments->seed, "of the random numbers; default: the scene's");
  app.add_option("--threads", arguments->threads, "0 = all cores; changes no bit of the image")
      ->check(CLI::Range(0, 4096))
      ->capture_default_str();
  app.add_option("--separate", arguments->separate,
                 "separate every measured material first and render it with this model; auto: the "
                 "cheapest within --tolerance")
      ->check(CLI::IsMember({"sun", "fresnel", "diffraction", "residual", "auto"}));
  app.add_option("--tolerance", arguments->tolerance,
                 "of --separate auto: share of the reflected light a model may get wrong")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  add_grid_option(app, arguments->grid);
  app.add_flag("--paired", arguments->paired,
               "for comparing pictures: whatever describes a measured material, draw the directions that its "
               "diffraction model draws, so that pictures share their noise");
  app.add_option("--cache", arguments->cache,
                 "folder that keeps separated materials; default: ~/.cache/spectrace");
  app.add_option("--exposure", arguments->exposure, "factor on the PNG, not on the EXR")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--texture-cache", arguments->texture_cache,
                 "mebibytes of textures kept in memory; changes no bit of the image")
      ->check(CLI::Range(20, 1 << 24))
      ->capture_default_str();
  app.add_flag("--layer-pngs", arguments->layer_pngs, "also write -diffuse.png and -specular.png");
  app.add_flag("--beauty-only", arguments->beauty_only,
               "leave out diffuse, specular, emission and background: faster");
  add_progress_option(app, arguments->progress);
  app.add_flag("--strict", arguments->strict, "exit with 1 if any sample was invalid (not finite, negative)");
  app.callback([&app, &chosen, arguments] {
    if (arguments->scene.empty() || !app.get_subcommands().empty()) {
      return;
    }
    if (!arguments->output.empty() && fs::path(arguments->output).extension() != ".exr") {
      throw CLI::ValidationError("--output", "must end in .exr");
    }
    chosen = [arguments] { return render_command(*arguments); };
  });
}

}  // namespace spectrace::cli
