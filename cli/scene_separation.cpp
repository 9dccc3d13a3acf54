// SPDX-License-Identifier: Apache-2.0
#include "cli/scene_separation.h"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <vector>

#include "cli/separation_cache.h"

namespace spectrace::cli {

namespace {

namespace fs = std::filesystem;

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

/// The material and all its parts; a part without a name has that of the whole, for messages.
std::vector<MaterialDesc*> all_parts(SceneDesc& scene) {
  std::vector<MaterialDesc*> parts;
  for (MaterialDesc& whole : scene.materials) {
    for_each_desc(whole, [&](MaterialDesc& part) {
      if (part.name.empty()) part.name = whole.name;
      parts.push_back(&part);
    });
  }
  return parts;
}

}  // namespace

void settle_models(SceneDesc& scene, Progress& progress) {
  for (MaterialDesc* const material : all_parts(scene)) {
    auto* separated = std::get_if<SeparatedDesc>(&material->kind);
    if (separated == nullptr || separated->model || !separated->tolerance) continue;
    const ModelChoice choice = choose_model(read_separated_source(separated->file), *separated->tolerance);
    separated->model = choice.model;
    progress.note(fmt::format("{}: model {}", material->name, choice.reason));
  }
}

bool separate_materials(SceneDesc& scene, const SceneSeparation& separation, Progress& progress) {
  const fs::path cache = separation.cache.empty() ? default_cache() : fs::path(separation.cache);
  const bool is_analytic = separation.model == kAnalyticModel;
  const std::optional<SeparationModel> model =
      separation_model_named(separation.model);  // none: auto, analytic
  SeparationOptions options;
  options.grid = separation.grid;
  options.threads = separation.threads;
  const bool may_need_residual = separation.model == "auto" || model == SeparationModel::kResidual;
  options.residual_rank = may_need_residual ? kDefaultResidualRank : 0;
  options.analytic = is_analytic;
  std::size_t count = 0;
  for (MaterialDesc* const each : all_parts(scene)) {
    MaterialDesc& material = *each;
    if (const auto* measured = std::get_if<MeasuredDesc>(&material.kind)) {
      const CachedSeparation separated =
          cached_separation(measured->file, cache, options, separation.quality, progress);
      if (!separated.report.usable) {
        progress.note(fmt::format("{}: {}", measured->file.string(), separated.report.verdict));
        return false;
      }
      progress.note(fmt::format("{}: {} {}{}", material.name,
                                separated.was_cached ? "separated before," : "separated into",
                                separated.file.string(),
                                separation.model.empty() ? ", which draws its directions (--paired)" : ""));
      if (measured->albedo != AlbedoLimit::kKeep && !separation.model.empty()) {
        progress.note(fmt::format(
            "{}: separated from the values as they were measured, whatever \"albedo\" says", material.name));
      }
      const fs::path directions = separation.paired ? separated.file : fs::path();
      ++count;
      if (separation.model.empty()) {
        material.kind = MeasuredDesc{measured->file, directions, measured->albedo};
        continue;
      }
      SeparatedDesc description{
          .file = separated.file, .model = model, .analytic = is_analytic, .directions = directions};
      if (!model && !is_analytic) {
        const ModelChoice choice = choose_model(MeasuredBrdf(read_measured(measured->file)),
                                                read_separated_source(separated.file), separation.tolerance);
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

}  // namespace spectrace::cli
