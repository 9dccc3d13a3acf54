// SPDX-License-Identifier: Apache-2.0
// What a user says of effects on the command line: simulate them in any case, or in none.
#pragma once

#include <string>
#include <vector>

#include "cli/command.h"
#include "core/base/progress.h"
#include "renderer/features.h"
#include "renderer/scene_desc.h"

namespace spectrace::cli {

struct EffectsOption {
  std::vector<std::string> forced, forbidden;
  bool only_list = false;

  [[nodiscard]] Features forced_features() const;
  /// Takes what is forbidden out of the scene, and notes it.
  void apply(SceneDesc& scene, Progress& progress) const;
};

/// --effects, --force-effect, --forbid-effect
void add_effects_option(CLI::App& app, EffectsOption& effects);

/// What will be simulated by which kernel, what not, and why: a line each.
void print_effects(const Scene& scene, const AovSet& aovs, const Features& forced);

}  // namespace spectrace::cli
