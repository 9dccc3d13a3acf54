// SPDX-License-Identifier: Apache-2.0
// The ways to render a scene that trade accuracy for time.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "cli/scene_separation.h"
#include "core/base/progress.h"
#include "renderer/scene_desc.h"

namespace spectrace::cli {

/// "exact", "model fresnel"
[[nodiscard]] inline std::string title_of(const std::string& knob, const std::string& name) {
  return knob == name ? name : knob + " " + name;
}

/// Of the setting that has the other sampler than the scene.
inline constexpr std::string_view kSamplerKnob = "sampler";

struct Setting {
  std::string knob;  ///< "exact", "sampler", "model", "path depth", "wavelengths", "without"
  std::string name;  ///< of its place on the knob: "fresnel"; unique with the knob
  /// What is changed of the scene. May throw InputError, as loading does.
  std::function<void(SceneDesc&, Progress&)> apply;

  [[nodiscard]] std::string title() const { return title_of(knob, name); }
};

/// What tells scenes apart, in words: "ball, floor; 4 shapes, 1 light, path depth 6". The same for a scene
/// with another camera, resolution or number of samples.
[[nodiscard]] std::string content_of(const SceneDesc& scene);

/// The scene as it is, first; then every step of every knob that the scene has. `separation`: grid and cache
/// of separated models.
[[nodiscard]] std::vector<Setting> settings_of(const SceneDesc& scene, const SceneSeparation& separation);

}  // namespace spectrace::cli
