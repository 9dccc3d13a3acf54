// SPDX-License-Identifier: Apache-2.0
// Effects that a scene has and a user forbids: the image is then an approximation, and says so.
#pragma once

#include <span>
#include <string_view>

#include "renderer/scene_desc.h"

namespace spectrace {

/// How to do without an effect.
struct Approximation {
  std::string_view effect;   ///< its name on the command line, FeatureInfo::id where it has one
  std::string_view instead;  ///< what is simulated in its place
  /// Takes the effect out of the scene; false: nothing had it.
  bool (*remove)(SceneDesc& scene);
};

[[nodiscard]] std::span<const Approximation> approximations();

/// Takes the effect out and notes it in scene.approximations. False, and nothing done, where nothing has it.
/// InternalError where there is no such approximation.
bool approximate(SceneDesc& scene, std::string_view effect);

}  // namespace spectrace
