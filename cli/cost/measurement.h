// SPDX-License-Identifier: Apache-2.0
// What a setting of a scene costs, and how far it is off.
#pragma once

#include <string>
#include <vector>

#include "cli/cost/parts.h"
#include "cli/cost/settings.h"
#include "core/image/error_model.h"
#include "core/image/metrics.h"
#include "renderer/features.h"

namespace spectrace::cli {

/// One render of a setting against the reference.
struct CostPoint {
  int spp = 0;
  double seconds = 0;
  Metrics metrics;       ///< of the beauty
  double ciede2000 = 0;  ///< mean over the picture, as exposed on the page
};

struct CostRecord {
  std::string knob, name, title, kernel;
  std::vector<CostPoint> points;  ///< by samples, at least two
  Estimate bias;                  ///< of relMSE; may be below 0
  ErrorModel model;
  std::size_t peak_memory_bytes = 0;  ///< of the process: this scene's, and the reference's images
  std::vector<PartBias> parts;        ///< by lobe and band
  Image picture;                      ///< of the last point: R, G, B
};

struct CostStudy {
  std::string scene, content;              ///< file, and content_of() it
  int width = 0, height = 0, threads = 0;  ///< as measured: pixels may be fewer than the scene's
  int scene_width = 0, scene_height = 0;
  int reference_spp = 0;  ///< 0: it was given
  double reference_seconds = 0;
  double reference_rel_mse = 0;  ///< its own noise
  EffectList effects;            ///< that the scene calls for, and that it does not
  double epsilon = 0;            ///< of relMSE: kRelativeEpsilon of the reference
  Image reference;               ///< R, G, B
  double exposure = 1;           ///< of the pictures
  std::vector<CostRecord> records;
  std::vector<std::string> left_out;  ///< settings that cannot be rendered, and why
};

struct CostOptions {
  double budget_seconds = 120;  ///< of all renders together
  std::string reference{};      ///< picture to take for the truth; empty: one is rendered
  int threads = 0;
};

/// A reference, then every setting at doubling numbers of samples, as many as the budget lets. What is left
/// of it is looked at before each step: where it is too little for three points a setting, the picture has
/// fewer pixels; where that is not enough, settings have two points, and what would still end after the
/// budget is left out, by name.
[[nodiscard]] CostStudy measure_cost(const SceneDesc& scene, const std::vector<Setting>& settings,
                                     const CostOptions& options, Progress& progress);

}  // namespace spectrace::cli
