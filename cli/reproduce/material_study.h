// SPDX-License-Identifier: Apache-2.0
// One material, separated with every model, pictured in every description, measured against its references.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "cli/reproduce/material_pictures.h"
#include "cli/reproduce/study_record.h"
#include "materials/choose_model.h"
#include "renderer/scene_desc.h"
#include "separation/compact.h"

namespace spectrace::cli {

struct StudyOptions {
  PictureOptions pictures;
  HalfDifferenceGrid grid;               ///< of the table X and all that comes from it
  int quality = kDefaultQuality;         ///< of the compact form, in which sun to residual are pictured
  double tolerance = kDefaultTolerance;  ///< of --model auto
};

struct MaterialStudy {
  StudyRecord record;
  /// "raw", "plain_table", "tabulated", "analytic", "sun", ..., "residual", and, of a material of the
  /// program's own, "truth"; empty where the fit is unusable.
  std::vector<Picture> pictures;
  std::string report_json;  ///< the separation's
};

/// A measured file, or a material of the program's own (.json), which the virtual goniophotometer then
/// measures and whose truth is a further reference. `step(share)` hears of the way done, in [0, 1]. Throws
/// InputError where the file is bad.
MaterialStudy study_material(const std::filesystem::path& input, Scene& scene, const StudyOptions& options,
                             const std::function<void(double share)>& step);

}  // namespace spectrace::cli
