// SPDX-License-Identifier: Apache-2.0
#include "cli/quality.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>
#include <vector>

#include "cli/cost/answers.h"
#include "cli/cost/settings.h"
#include "cli/cost/study_json.h"
#include "core/base/error.h"

namespace spectrace::cli {

namespace {

/// A knob that makes another kind of image, spectral ones, is not for getting the same image sooner.
constexpr std::string_view kOtherImage = "wavelengths";

/// As it would be at this scene's resolution.
CostStudy measured_for(const SceneDesc& scene) {
  CostStudy study = read_cost_study(scene.quality.measurement);
  if (const std::string content = content_of(scene); content != study.content) {
    throw InputError(scene.quality.measurement.string(), "",
                     fmt::format("measured on another scene, {} ({}); this one has {}", study.scene,
                                 study.content, content));
  }
  const double pixels =
      double(scene.film.width) * double(scene.film.height) / (double(study.width) * double(study.height));
  std::erase_if(study.records, [](const CostRecord& record) { return record.knob == kOtherImage; });
  for (CostRecord& record : study.records) record.model.per_sample *= pixels;
  return study;
}

const Setting& find_setting(const std::vector<Setting>& settings, const SceneDesc& scene,
                            const std::string& title) {
  const auto found = std::find_if(settings.begin(), settings.end(),
                                  [&](const Setting& setting) { return setting.title() == title; });
  if (found == settings.end()) {
    throw InputError(
        scene.quality.measurement.string(), "",
        fmt::format("its best setting is \"{}\", which {} does not have: was another scene measured?", title,
                    scene.file_name));
  }
  return *found;
}

}  // namespace

std::string text_of(const QualityDesc& quality) {
  if (quality.seconds > 0) return fmt::format("{:g} s", quality.seconds);
  return fmt::format("relative error {:g}", quality.relative_error);
}

void pick_setting(SceneDesc& scene, const SceneSeparation& separation, Progress& progress) {
  const QualityDesc quality = scene.quality;
  if (quality.measurement.empty()) return;
  const CostStudy study = measured_for(scene);
  const double wanted = quality.relative_error * quality.relative_error;
  const std::optional<Answer> answer =
      quality.seconds > 0 ? best_within(study, quality.seconds) : cheapest(study, wanted);
  if (!answer) {
    throw InputError(quality.measurement.string(), "",
                     fmt::format("no setting reaches a quality of {}", text_of(quality)));
  }
  const std::string title = answer->record->title;
  const std::vector<Setting> settings = settings_of(scene, separation);
  find_setting(settings, scene, title).apply(scene, progress);
  if (quality.relative_error > 0) {
    // Halves of the image know nothing of a bias: the samples are the measurement's.
    scene.spp = int(std::clamp(std::ceil(answer->samples), 1.0, 1e9));
    scene.quality = {};
  }
  if (const std::string& knob = answer->record->knob; knob != "exact" && knob != kSamplerKnob) {
    scene.approximations.push_back(fmt::format("{} for a quality of {}", title, text_of(quality)));
  }
  progress.note(fmt::format("quality {}: {}, {:.0f} samples, {:.3g} s and a relative error of {:.3g} by {}",
                            text_of(quality), title, std::ceil(answer->samples), answer->seconds,
                            std::sqrt(answer->rel_mse), quality.measurement.string()));
}

}  // namespace spectrace::cli
