// SPDX-License-Identifier: Apache-2.0
// The scene on which descriptions of one material are compared: a sphere and a bumpy ball under a sky.
#pragma once

#include <filesystem>

#include "renderer/scene_desc.h"

namespace spectrace::cli {

struct ReferenceSceneOptions {
  std::filesystem::path environment{};  ///< latitude-longitude image; empty: a studio of five soft lamps
  int height = 144;                     ///< pixels; twice as wide
};

/// Writes scene.json, ball.obj and, where it is not the user's, studio.exr to `folder` (made where absent)
/// and loads them. Materials: one, a placeholder, on both shapes. Roulette is off, so that paths do not
/// depend on the material's values.
SceneDesc write_reference_scene(const std::filesystem::path& folder, const ReferenceSceneOptions& options);

}  // namespace spectrace::cli
