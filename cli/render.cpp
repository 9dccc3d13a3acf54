// SPDX-License-Identifier: Apache-2.0
// `spectrace SCENE.json [-o OUT.exr]`: the main command.
#include "renderer/render.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/aovs_option.h"
#include "cli/command.h"
#include "cli/console_progress.h"
#include "cli/effects_option.h"
#include "cli/grid_option.h"
#include "cli/option_values.h"
#include "cli/output.h"
#include "cli/quality.h"
#include "cli/render_loop.h"
#include "cli/render_output.h"
#include "cli/sampler_option.h"
#include "cli/scene_separation.h"
#include "core/base/error.h"
#include "core/image/tev_view.h"
#include "core/image/texture_cache.h"
#include "renderer/partial_render.h"
#include "renderer/provenance.h"

namespace spectrace::cli {

namespace {

namespace fs = std::filesystem;

constexpr int kMaxSpp = 1 << 30;
constexpr double kViewSeconds = 0.25;

struct Arguments {
  std::string scene;
  RenderOutput output;
  std::optional<int> spp;
  std::optional<SampleRange> samples;
  std::optional<std::uint64_t> seed;
  std::optional<SamplerKind> sampler;
  std::optional<AovSet> aovs;
  int threads = 0;
  double seconds = 0, relative_error = 0;
  double checkpoint_seconds = 0;
  bool resume = false;
  std::optional<TevAddress> tev;
  std::size_t texture_cache = kTextureCacheMiB;
  SceneSeparation separation;
  EffectsOption effects;
  ProgressStyle progress = ProgressStyle::kAuto;
  bool strict = false;
};

fs::path output_file(const Arguments& arguments) {
  const std::string model = arguments.separation.model.empty() ? "" : "-" + arguments.separation.model;
  fs::path file = arguments.output.file;
  if (file.empty()) file = fs::path(arguments.scene).stem().concat(model + ".exr");
  require_folder_of(file);
  return file;
}

/// What is asked for here takes the place of the scene's "quality".
void set_quality(const Arguments& arguments, SceneDesc& scene, Progress& progress) {
  if (arguments.spp || arguments.samples || arguments.seconds > 0 || arguments.relative_error > 0) {
    scene.quality = {};
    scene.quality.seconds = arguments.seconds;
    scene.quality.relative_error = arguments.relative_error;
  } else {
    pick_setting(scene, arguments.separation, progress);
  }
}

/// How many samples: what is asked for, as many as it takes where another end is, else the scene's.
RenderOptions render_options(const Arguments& arguments, const Scene& scene) {
  RenderOptions options{.spp = arguments.spp.value_or(scene.spp),
                        .seed = arguments.seed.value_or(scene.seed),
                        .threads = arguments.threads,
                        .aovs = arguments.aovs.value_or(scene.aovs),
                        .forced = arguments.effects.forced_features(),
                        .seconds = scene.quality.seconds,
                        .relative_error = scene.quality.relative_error};
  if (!arguments.spp && scene.quality.is_asked()) options.spp = kMaxSpp;
  if (arguments.samples) {
    options.first = arguments.samples->first;
    options.spp = int(arguments.samples->count());
  }
  return options;
}

struct Start {
  Film film;
  std::optional<Metadata> header;  ///< of the checkpoint that the film is of
};

/// The film of a checkpoint, or an empty one where there is none yet.
Start film_to_start_with(const Scene& scene, const RenderOptions& options, const Arguments& arguments,
                         Progress& progress) {
  Film film = new_film(scene, options);
  const fs::path file = partial_file(arguments.output);
  if (!arguments.resume) return {std::move(film), {}};
  if (!fs::exists(file)) {
    progress.note(fmt::format("{}: there is none yet, starting from nothing", file.string()));
    return {std::move(film), {}};
  }
  PartialRender partial = read_partial(file);
  check_same_image(partial, file, identity_of(scene, options.seed), film.width(), film.height(),
                   film.layout());
  if (partial.film.target().first != options.first || !partial.film.set_last(film.target().last)) {
    const SampleRange range = partial.film.target();
    throw InputError(file.string(), "",
                     fmt::format("holds samples of {}:{}, which do not go on to {}:{}", range.first,
                                 range.last, options.first, film.target().last));
  }
  progress.note(fmt::format("{}: going on after {} samples a pixel", file.string(),
                            partial.film.ends().first * kLeafSamples - options.first));
  return {std::move(partial.film), std::move(partial.metadata)};
}

/// `before`: of what the session went on with.
Metadata header_of(const Scene& scene, const RenderOptions& options, const RenderSession& session,
                   const Arguments& arguments, const std::optional<Metadata>& before) {
  Metadata metadata = provenance(scene, options, session.report());
  if (!arguments.separation.model.empty()) metadata["spectrace:separation"] = arguments.separation.model;
  metadata["spectrace:paired"] = std::int64_t(arguments.separation.paired);
  return before ? joined_provenance(std::move(metadata), *before) : metadata;
}

void print_summary(const fs::path& file, const Scene& scene, const Film& film, const RenderReport& report) {
  fmt::print(
      "{}: {} x {}, {} samples a pixel, {:.2f} s on {} threads, {:.3g} million paths/s, {} invalid samples\n",
      file.string(), film.width(), film.height(), report.samples.count(), report.seconds, report.threads,
      report.seconds > 0 ? double(report.paths) / report.seconds * 1e-6 : 0, report.invalid_samples);
  if (scene.quality.is_asked()) {
    fmt::print("quality {}: {} samples a pixel\n", text_of(scene.quality), report.samples.count());
  }
  if (film.layout().aovs.halves) {
    const double error = film.relative_error();
    fmt::print("relative error: {}\n", std::isfinite(error) ? fmt::format("{:.3g}", error) : "unknown");
  }
  if (report.extrapolated_share > 0) {
    fmt::print("extrapolated: {:.2g} % of the measured values seen lie beyond the last measured elevation\n",
               100 * report.extrapolated_share);
  }
  fmt::print("kernel: {}\nsimulated: {}\n", report.kernel, fmt::join(report.effects.used, "; "));
  fmt::print("not simulated: {}\n", fmt::join(report.effects.skipped, "; "));
  for (const std::string& approximation : scene.approximations) {
    fmt::print("approximation {}\n", approximation);
  }
}

ExitCode render_command(Arguments arguments) {
  ConsoleProgress progress(arguments.progress);
  arguments.output.file = output_file(arguments);
  set_texture_cache_limit(arguments.texture_cache);
  SceneDesc description = load_scene(arguments.scene);
  settle_models(description, progress);
  arguments.separation.threads = arguments.threads;
  if (arguments.separation.is_asked() && !separate_materials(description, arguments.separation, progress)) {
    return ExitCode::kDiffers;
  }
  // Roulette follows the throughput: with it paths of different materials would part.
  if (arguments.separation.paired) description.integrator.roulette_depth = description.integrator.max_depth;
  if (arguments.sampler) description.sampler = *arguments.sampler;
  arguments.effects.apply(description, progress);
  set_quality(arguments, description, progress);
  const Scene scene = build_scene(description, progress);
  const RenderOptions options = render_options(arguments, scene);
  if (arguments.effects.only_list) {
    progress.finish();
    print_effects(scene, options.aovs, options.forced);
    return ExitCode::kSuccess;
  }
  Start start = film_to_start_with(scene, options, arguments, progress);
  RenderSession session(scene, options, std::move(start.film));

  const auto header = [&] { return header_of(scene, options, session, arguments, start.header); };
  const auto save = [&] {
    write_partial(partial_file(arguments.output),
                  {identity_of(scene, options.seed), header(), session.film()});
  };
  std::vector<Recurring> tasks;
  if (arguments.checkpoint_seconds > 0) tasks.push_back({arguments.checkpoint_seconds, save});
  std::optional<TevView> view;
  if (arguments.tev) {
    view.emplace(*arguments.tev, arguments.output.file.filename().string(), progress);
    tasks.push_back({kViewSeconds, [&] {
                       if (view->wants_picture()) view->show(session.film().resolve());
                     }});
  }
  const SignalWatch watch;
  const bool is_done = run(session, tasks, progress);
  if (view) view->finish(session.film().resolve());

  const bool keeps_partial = arguments.checkpoint_seconds > 0 || arguments.resume || arguments.samples;
  if (keeps_partial) save();
  write_images(arguments.output, session.film(), header());
  progress.finish();
  const RenderReport report = session.report();
  print_summary(arguments.output.file, scene, session.film(), report);
  if (!is_done) {
    fmt::print("interrupted: {}\n",
               keeps_partial ? "--resume goes on" : "without --checkpoint, nothing to go on with");
    return ExitCode::kInterrupted;
  }
  return arguments.strict && report.invalid_samples > 0 ? ExitCode::kDiffers : ExitCode::kSuccess;
}

/// "FIRST:LAST"
SampleRange parse_samples(const std::string& text) {
  const auto wrong = [&](const std::string& problem) { return CLI::ValidationError("--samples", problem); };
  const std::size_t colon = text.find(':');
  SampleRange range;
  if (colon == std::string::npos || !CLI::detail::lexical_cast(text.substr(0, colon), range.first) ||
      !CLI::detail::lexical_cast(text.substr(colon + 1), range.last)) {
    throw wrong(fmt::format("expected FIRST:LAST, got \"{}\"", text));
  }
  if (range.first >= range.last || range.last > kMaxSpp) {
    throw wrong(fmt::format("expected FIRST below LAST, and LAST at most {}", kMaxSpp));
  }
  if (range.first % kLeafSamples != 0) {
    throw wrong(
        fmt::format("FIRST must be a multiple of {}: samples are traced in packs of it", kLeafSamples));
  }
  return range;
}

void add_sample_options(CLI::App& app, Arguments& arguments) {
  auto* spp = app.add_option("--spp", arguments.spp, "samples a pixel; default: the scene's")
                  ->check(CLI::Range(1, kMaxSpp));
  app.add_option("--time", arguments.seconds, "stop after so many seconds of rendering, all pixels alike")
      ->check(seconds_above_zero());
  app.add_option("--noise", arguments.relative_error,
                 "stop at this relative error of the image, as its two halves tell (docs/aovs.md)")
      ->check(above_zero());
  app.add_option_function<std::string>(
         "--samples", [&arguments](const std::string& text) { arguments.samples = parse_samples(text); },
         "take samples FIRST:LAST of each pixel only (LAST is not among them) and write OUT.partial, for "
         "`spectrace merge`")
      ->excludes(spp);
  app.add_option("--checkpoint", arguments.checkpoint_seconds,
                 "write OUT.partial every so many seconds, and at the end")
      ->check(seconds_above_zero());
  app.add_flag("--resume", arguments.resume,
               "go on with OUT.partial, if there is one, to the identical image");
}

TevAddress parse_tev(const std::string& text) {
  if (const auto address = parse_tev_address(text)) return *address;
  throw CLI::ValidationError("--tev", fmt::format("expected HOST:PORT, got \"{}\"", text));
}

void add_separation_options(CLI::App& app, SceneSeparation& separation) {
  app.add_option("--separate", separation.model,
                 "separate every measured material first and render it with this model; auto: the "
                 "cheapest within --tolerance")
      ->check(CLI::IsMember({"sun", "fresnel", "diffraction", "residual", "analytic", "auto"}));
  app.add_option("--tolerance", separation.tolerance,
                 "of --separate auto: share of the reflected light a model may get wrong")
      ->check(from_zero_to_one())
      ->capture_default_str();
  add_grid_option(app, separation.grid);
  app.add_flag("--paired", separation.paired,
               "for comparing pictures: whatever describes a measured material, draw the directions that its "
               "diffraction model draws, so that pictures share their noise");
  app.add_option("--cache", separation.cache,
                 "folder that keeps separated materials; default: ~/.cache/spectrace");
}

void add_output_options(CLI::App& app, Arguments& arguments) {
  app.add_option("-o,--output", arguments.output.file,
                 "image to write (.exr), a .png beside it; default: the scene's name, and the model's of "
                 "--separate, in the current folder");
  add_aovs_option(app, arguments.aovs, "the scene's \"aovs\", else lobes");
  const std::map<std::string, AovNames> names{
      {"arnold", AovNames::kArnold}, {"blender", AovNames::kBlender}, {"kpcn", AovNames::kKpcn}};
  take_one_of(app.add_option("--aov-names", arguments.output.names, "whose names the channels get"), names)
      ->default_str("arnold");
  app.add_option("--exposure", arguments.output.exposure, "factor on the PNG, not on the EXR")
      ->check(above_zero())
      ->capture_default_str();
  app.add_option_function<std::string>(
      "--tev", [&arguments](const std::string& text) { arguments.tev = parse_tev(text); },
      "show the picture in tev while it is made, at HOST:PORT (tev's own: 127.0.0.1:14158)");
  app.add_flag("--layer-pngs", arguments.output.layer_pngs, "also write -diffuse.png and -specular.png");
}

}  // namespace

void add_render(CLI::App& app, Action& chosen) {
  const auto arguments = std::make_shared<Arguments>();
  app.add_option("scene", arguments->scene, "scene to render (.json)");
  add_output_options(app, *arguments);
  add_sample_options(app, *arguments);
  app.add_option("--seed", arguments->seed, "of the random numbers; default: the scene's");
  add_sampler_option(app, arguments->sampler);
  app.add_option("--threads", arguments->threads, "0 = all cores; changes no bit of the image")
      ->check(CLI::Range(0, 4096))
      ->capture_default_str();
  add_separation_options(app, arguments->separation);
  add_effects_option(app, arguments->effects);
  app.add_option("--texture-cache", arguments->texture_cache,
                 "mebibytes of textures kept in memory; changes no bit of the image")
      ->check(CLI::Range(20, 1 << 24))
      ->capture_default_str();
  add_progress_option(app, arguments->progress);
  app.add_flag("--strict", arguments->strict, "exit with 1 if any sample was invalid (not finite, negative)");
  app.callback([&app, &chosen, arguments] {
    if (arguments->scene.empty() || !app.get_subcommands().empty()) {
      return;
    }
    if (!arguments->output.file.empty() && arguments->output.file.extension() != ".exr") {
      throw CLI::ValidationError("--output", "must end in .exr");
    }
    chosen = [arguments] { return render_command(*arguments); };
  });
}

}  // namespace spectrace::cli
