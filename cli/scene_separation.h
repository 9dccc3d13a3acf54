// SPDX-License-Identifier: Apache-2.0
// Separating the measured materials of a scene before it is rendered.
#pragma once

#include <string>
#include <string_view>

#include "core/base/progress.h"
#include "materials/choose_model.h"
#include "materials/half_difference_grid.h"
#include "renderer/scene_desc.h"
#include "separation/compact.h"

namespace spectrace::cli {

/// Lambert + GGX at each wavelength (sec. 5.3 of the paper), among the models' names.
inline constexpr std::string_view kAnalyticModel = "analytic";

struct SceneSeparation {
  std::string model;  ///< a model's name, "analytic", "auto", or empty: none
  double tolerance = kDefaultTolerance;
  HalfDifferenceGrid grid;
  int quality = kDefaultQuality;  ///< of the compact tables
  bool paired = false;
  std::string cache;  ///< folder; empty: the user's
  int threads = 0;

  [[nodiscard]] bool is_asked() const { return !model.empty() || paired; }
};

/// Separated materials of the model "auto" get the model that they are rendered with, noted with the reason.
void settle_models(SceneDesc& scene, Progress& progress);

/// Every measured material becomes its separated form, or with `paired` alone draws its directions. False,
/// with the reason noted, where one cannot.
bool separate_materials(SceneDesc& scene, const SceneSeparation& separation, Progress& progress);

}  // namespace spectrace::cli
