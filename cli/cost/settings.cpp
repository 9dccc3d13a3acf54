// SPDX-License-Identifier: Apache-2.0
#include "cli/cost/settings.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/error.h"
#include "renderer/approximations.h"

namespace spectrace::cli {

namespace {

bool has_measured(const SceneDesc& scene) {
  bool any = false;
  for (const MaterialDesc& material : scene.materials) {
    for_each_desc(material, [&](const MaterialDesc& part) {
      any = any || std::holds_alternative<MeasuredDesc>(part.kind);
    });
  }
  return any;
}

Setting with_model(const std::string& model, SceneSeparation separation) {
  separation.model = model;
  return {"model", model, [separation](SceneDesc& scene, Progress& progress) {
            if (!separate_materials(scene, separation, progress)) {
              throw InputError(scene.file_name, "", "a measured material cannot be separated");
            }
          }};
}

/// Of the richest model that is not a correction; its default is among the models.
Setting with_sep_quality(int quality, SceneSeparation separation) {
  separation.quality = quality;
  Setting setting = with_model("diffraction", std::move(separation));
  setting.knob = ".sep quality";
  setting.name = std::to_string(quality);
  return setting;
}

Setting with_depth(int depth) {
  return {"path depth", std::to_string(depth),
          [depth](SceneDesc& scene, Progress&) { scene.integrator.max_depth = depth; }};
}

/// As many different wavelengths a path, drawn as the scene's own are.
Setting with_lanes(int lanes) {
  return {"hero lanes", std::to_string(lanes), [lanes](SceneDesc& scene, Progress&) { scene.lanes = lanes; }};
}

/// Paths carry the centres of so many bins and nothing else.
Setting with_wavelengths(std::size_t count) {
  return {"wavelengths", std::to_string(count), [count](SceneDesc& scene, Progress&) {
            scene.film.spectral = SpectralFilmDesc{{scene.range, count, true}, false};
          }};
}

/// What the scene's own is held against: independent samples, whose noise falls as 1/samples, or stratified.
Setting with_other_sampler(SamplerKind own) {
  const SamplerKind other =
      own == SamplerKind::kIndependent ? SamplerKind::kOwenSobol : SamplerKind::kIndependent;
  return {std::string(kSamplerKnob), std::string(sampler_name(other)),
          [other](SceneDesc& scene, Progress&) { scene.sampler = other; }};
}

Setting without(std::string_view effect) {
  return {"without", std::string(effect),
          [effect](SceneDesc& scene, Progress&) { (void)approximate(scene, effect); }};
}

}  // namespace

std::string content_of(const SceneDesc& scene) {
  std::vector<std::string> names;
  for (const MaterialDesc& material : scene.materials) names.push_back(material.name);
  return fmt::format("{}; {} shapes, {} lights, path depth {}", fmt::join(names, ", "), scene.shapes.size(),
                     scene.lights.size(), scene.integrator.max_depth);
}

std::vector<Setting> settings_of(const SceneDesc& scene, const SceneSeparation& separation) {
  std::vector<Setting> settings{{"exact", "exact", [](SceneDesc&, Progress&) {}}};
  settings.push_back(with_other_sampler(scene.sampler));
  if (has_measured(scene)) {
    for (const char* model : {"residual", "diffraction", "fresnel", "sun", "analytic"}) {
      settings.push_back(with_model(model, separation));
    }
    for (const int quality : {1, 3, 11}) settings.push_back(with_sep_quality(quality, separation));
  }
  for (const int depth : {1, 2, 4, 8}) {
    if (depth < scene.integrator.max_depth) settings.push_back(with_depth(depth));
  }
  for (const int lanes : {1, 2, 4}) {
    if (lanes < scene.lanes) settings.push_back(with_lanes(lanes));
  }
  if (!scene.film.spectral) {
    for (const std::size_t count : {3, 8, 31, 64, 195}) settings.push_back(with_wavelengths(count));
  }
  for (const Approximation& approximation : approximations()) {
    SceneDesc changed = scene;
    // Path depth 1 is among the depths already.
    const bool is_used = approximate(changed, approximation.effect);
    if (is_used && approximation.effect != "indirect-light") {
      settings.push_back(without(approximation.effect));
    }
  }
  return settings;
}

}  // namespace spectrace::cli
