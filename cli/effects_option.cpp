// SPDX-License-Identifier: Apache-2.0
#include "cli/effects_option.h"

#include <fmt/format.h>

#include <algorithm>

#include "renderer/approximations.h"
#include "renderer/kernels.h"

namespace spectrace::cli {

Features EffectsOption::forced_features() const {
  Features features;
  for (const FeatureInfo& info : kFeatureInfos) {
    for (const std::string& name : forced) features.*info.flag |= name == info.id;
  }
  return features;
}

void EffectsOption::apply(SceneDesc& scene, Progress& progress) const {
  for (const std::string& effect : forbidden) {
    if (approximate(scene, effect)) {
      progress.note(fmt::format("approximation {}", scene.approximations.back()));
    } else {
      progress.note(fmt::format("{} is forbidden, but nothing in the scene has it", effect));
    }
  }
}

void add_effects_option(CLI::App& app, EffectsOption& effects) {
  app.add_flag("--effects", effects.only_list,
               "say which effects the scene calls for, which not, and why; render nothing");
  std::vector<std::string> all, removable;
  for (const FeatureInfo& info : kFeatureInfos) all.emplace_back(info.id);
  for (const Approximation& approximation : approximations()) removable.emplace_back(approximation.effect);
  app.add_option("--force-effect", effects.forced,
                 "simulate an effect though the scene does not call for it; changes no bit of the image")
      ->check(CLI::IsMember(all))
      ->take_all();
  app.add_option("--forbid-effect", effects.forbidden,
                 "do without an effect though the scene calls for it: an approximation, which the image's "
                 "header tells of")
      ->check(CLI::IsMember(removable))
      ->take_all();
}

void print_effects(const Scene& scene, const AovSet& aovs, const Features& forced) {
  const Kernel& kernel = choose_kernel(united(required_features(scene, aovs), forced));
  const EffectList list = list_effects(scene, aovs, forced, kernel.features);
  fmt::print("kernel: {}\n", kernel.name);
  for (const std::string& effect : list.used) fmt::print("simulated      {}\n", effect);
  for (const std::string& effect : list.skipped) fmt::print("not simulated  {}\n", effect);
  for (const std::string& approximation : scene.approximations) {
    fmt::print("approximation  {}\n", approximation);
  }
}

}  // namespace spectrace::cli
