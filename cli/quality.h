// SPDX-License-Identifier: Apache-2.0
// A scene's "quality": what the render is to reach, and the setting that is to bring it there.
#pragma once

#include <string>

#include "cli/scene_separation.h"
#include "core/base/progress.h"
#include "renderer/render.h"
#include "renderer/scene_desc.h"

namespace spectrace::cli {

/// Changes the scene as a measurement of `spectrace cost` says, where its "quality" names one: to the setting
/// that reaches the relative error soonest, with the samples it takes, or that comes nearest in the seconds.
/// Notes what was picked; what is not exact becomes one of the scene's approximations. Throws InputError
/// where the measurement is of another scene, or has no setting that reaches the error.
void pick_setting(SceneDesc& scene, const SceneSeparation& separation, Progress& progress);

/// "relative error 0.01", "30 s"
[[nodiscard]] std::string text_of(const QualityDesc& quality);

}  // namespace spectrace::cli
