// SPDX-License-Identifier: Apache-2.0
// `spectrace SCENE.json`: the main command. Separates the scene's measured materials first where asked to.
#include "renderer/render.h"

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "cli/command.h"
#include "cli/console_progress.h"
#include "cli/separation_cache.h"
#include "core/base/error.h"
#include "core/image/image.h"
#include "renderer/scene.h"
#include "renderer/scene_desc.h"

namespace spectrace::cli {
namespace {

namespace fs = std::filesystem;

struct Arguments {
  std::string scene, output, separate;
  std::optional<int> spp;
  std::optional<std::uint64_t> seed;
  int threads = 0;
  bool strict = false;
};

SeparationModel model_named(std::string_view name) {
  for (const SeparationModel model :
       {SeparationModel::kSun, SeparationModel::kFresnel, SeparationModel::kDiffraction}) {
    if (name_of(model) == name) return model;
  }
  throw InternalError(fmt::format("no model is named \"{}\"", name));  // the command line has checked it
}

/// Replaces every measured material by its separated form, kept in `cache` for the next time.
void separate_materials(SceneDesc& scene, SeparationModel model, const fs::path& cache, int threads,
                        Progress& progress) {
  SeparationOptions options;
  options.threads = threads;
  for (MaterialDesc& material : scene.materials) {
    const auto* measured = std::get_if<MeasuredDesc>(&material.kind);
    if (measured == nullptr) continue;
    const CachedSeparation separated = cached_separation(measured->file, cache, options, progress);
    progress.note(
        separated.was_cached
            ? fmt::format("material \"{}\": separated before, {}", material.name, separated.file.string())
            : fmt::format("material \"{}\": {}", material.name, separated.report.brief()));
    material.kind = SeparatedDesc{separated.file, model};
  }
}

std::string joined(const std::vector<std::string>& parts) {
  return parts.empty() ? "none" : fmt::format("{}", fmt::join(parts, "; "));
}

/// The picture to look at beside an EXR: out.png, out.diffuse.png, ...
fs::path picture_path(const fs::path& exr, std::string_view layer) {
  fs::path file = exr;
  return file.replace_extension(layer.empty() ? ".png" : fmt::format(".{}.png", layer));
}

void write_outputs(const fs::path& output, const Image& image, const Metadata& metadata) {
  write_exr(output, image, metadata);
  for (const std::string_view layer : {"", "diffuse", "specular"}) {
    write_png(picture_path(output, layer), image, layer);
  }
}

void print_report(const fs::path& output, const RenderReport& report) {
  fmt::print("kernel   {}\n", report.kernel);
  fmt::print("used     {}\n", joined(report.effects_used));
  fmt::print("skipped  {}\n", joined(report.effects_skipped));
  fmt::print("paths    {} in {:.2f} s on {} threads, {:.2f} million a second\n", report.paths, report.seconds,
             report.threads, double(report.paths) / report.seconds * 1e-6);
  fmt::print("invalid  {} samples dropped\n", report.invalid_samples);
  fmt::print("wrote    {}, {}, {}, {}\n", output.string(), picture_path(output, "").string(),
             picture_path(output, "diffuse").string(), picture_path(output, "specular").string());
}

ExitCode render_command(const Arguments& arguments) {
  const fs::path output = arguments.output.empty()
                              ? fs::path(arguments.scene).filename().replace_extension(".exr")
                              : fs::path(arguments.output);
  ConsoleProgress progress;
  SceneDesc description = load_scene(arguments.scene);
  if (!arguments.separate.empty()) {
    separate_materials(description, model_named(arguments.separate), output.parent_path() / "separated.cache",
                       arguments.threads, progress);
  }
  const Scene scene = build_scene(description, progress);
  const RenderOptions options{.spp = arguments.spp.value_or(scene.spp),
                              .seed = arguments.seed.value_or(scene.seed),
                              .threads = arguments.threads};
  const RenderResult result = render(scene, options, progress);
  progress.finish();

  Metadata metadata = provenance(scene, options, result.report);
  if (!arguments.separate.empty()) metadata["spectrace:separationModel"] = arguments.separate;
  write_outputs(output, result.image, metadata);
  print_report(output, result.report);
  return arguments.strict && result.report.invalid_samples > 0 ? ExitCode::kDiffers : ExitCode::kSuccess;
}

}  // namespace

void add_render(CLI::App& app, Action& chosen) {
  const auto arguments = std::make_shared<Arguments>();
  app.add_option("scene", arguments->scene, "scene to render (.json)");
  app.add_option("-o,--output", arguments->output,
                 "image to write (.exr), a .png beside it; default: the scene's name, here")
      ->check([](const std::string& name) {
        return fs::path(name).extension() == ".exr" ? std::string() : "must end in .exr: " + name;
      });
  app.add_option("--spp", arguments->spp, "samples a pixel, instead of the scene's")
      ->check(CLI::Range(1, 1 << 30));
  app.add_option("--seed", arguments->seed, "seed of the random numbers, instead of the scene's");
  app.add_option("--threads", arguments->threads,
                 "threads to use, 0 = all cores; changes no bit of the image")
      ->check(CLI::Range(0, 4096))
      ->capture_default_str();
  app.add_option("--separate", arguments->separate,
                 "separate every measured material first and render it with this model")
      ->check(CLI::IsMember({"sun", "fresnel", "diffraction"}));
  app.add_flag("--strict", arguments->strict, "exit with 1 where any sample had to be dropped");
  app.callback([arguments, &chosen] {
    if (!arguments->scene.empty()) chosen = [arguments] { return render_command(*arguments); };
  });
}

}  // namespace spectrace::cli
