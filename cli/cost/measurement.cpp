// SPDX-License-Identifier: Apache-2.0
#include "cli/cost/measurement.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <utility>

#include "cli/report/exposure.h"
#include "core/base/cost.h"
#include "core/base/error.h"
#include "core/image/color_error.h"
#include "renderer/render.h"

namespace spectrace::cli {

namespace {

/// Of the budget: the reference's share. The error of a setting with as much noise as the exact one is then
/// told from its own at a few times the samples.
constexpr double kReferenceShare = 0.3;
/// What is left to write the report in.
constexpr double kMeasuringShare = 0.95;
/// Settings that would begin later are left out.
constexpr double kMostOverdraft = 1.1;
constexpr int kFewestPoints = 3, kMostPoints = 10;
/// Where the budget has no time for three: a line goes through two.
constexpr int kFewestPointsInHaste = 2;
constexpr int kLeastReferenceSpp = 64;
/// A pack of samples: fewer leave lanes empty, and would seem slower than they are.
constexpr int kFirstSpp = int(kLeafSamples);
constexpr int kProbeSpp = kFirstSpp, kPartSpp = kFirstSpp, kReferencePartSpp = 4 * kFirstSpp;
constexpr std::uint64_t kReferenceSeed = 0x5eed;  // no setting's: their errors must not follow it

Image beauty_of(const RenderResult& result) {
  const std::array<std::string, 3> channels{"R", "G", "B"};
  return result.image.select(channels, "render");
}

RenderResult render_at(const Scene& scene, int spp, std::uint64_t seed, const CostOptions& options) {
  SilentProgress silent;
  return render(scene, {.spp = spp, .seed = seed, .threads = options.threads, .aovs = kNoAovs}, silent);
}

/// The scene as it is, twice: what the two do not share tells noise from bias.
struct Reference {
  Image first, second, mean;
  MetricOptions metrics;
  double exposure = 1;

  [[nodiscard]] IndependentPair pair() const { return {first, second}; }
};

Image mean_of(const Image& a, const Image& b) {
  Image mean = a;
  for (std::size_t i = 0; i < mean.data.size(); ++i) mean.data[i] = (a.data[i] + b.data[i]) / 2;
  return mean;
}

Reference reference_of(Image first, Image second) {
  Image mean = mean_of(first, second);
  double sum = 0;
  for (const float value : mean.data) sum += double(value);
  const double of_all = sum / double(mean.data.size());
  MetricOptions metrics;
  // Where all is dark, as good as any.
  if (of_all > 0) metrics.epsilon = kRelativeEpsilon * of_all * of_all;
  const double exposure = exposure_of(mean);
  return {std::move(first), std::move(second), std::move(mean), metrics, exposure};
}

/// R, G, B of a file, as large as what is rendered.
Image given_reference(const std::string& file, const CropWindow& window) {
  const std::array<std::string, 3> channels{"R", "G", "B"};
  Image given = read_image(file).select(channels, file);
  if (given.width != window.width || given.height != window.height) {
    throw InputError(file, "",
                     fmt::format("has {} x {} pixels, the scene {} x {}", given.width, given.height,
                                 window.width, window.height));
  }
  return given;
}

/// Renders at 8, 16, 32 ... samples while the time lasts, each with a seed of its own: points that shared
/// samples would share their errors.
CostRecord measure(const Setting& setting, const Scene& scene, const Reference& reference, double seconds,
                   int fewest_points, const CostOptions& options) {
  CostRecord record;
  record.knob = setting.knob;
  record.name = setting.name;
  record.title = setting.title();
  Image before;
  double spent = 0, last = 0;
  for (int i = 0; i < kMostPoints; ++i) {
    if (i >= fewest_points && spent + 2 * last > seconds) break;
    const int spp = kFirstSpp << i;
    const RenderResult result = render_at(scene, spp, scene.seed + std::uint64_t(i) + 1, options);
    record.kernel = result.report.kernel;
    before = std::exchange(record.picture, beauty_of(result));
    last = result.report.seconds;
    spent += last;
    record.points.push_back({spp, last, compare_images(reference.mean, record.picture, reference.metrics),
                             mean_ciede2000(reference.mean, record.picture, reference.exposure)});
  }
  const double epsilon = reference.metrics.epsilon;
  record.bias = bias_rel_mse({before, record.picture}, reference.pair(), epsilon);
  std::vector<ErrorPoint> points;
  for (const CostPoint& point : record.points) {
    points.push_back({double(point.spp), point.seconds, point.metrics.rel_mse});
  }
  record.model = fit_error_model(points, record.bias.value, noise_rel_mse(reference.pair(), epsilon).value);
  return record;
}

}  // namespace

CostStudy measure_cost(const SceneDesc& description, const std::vector<Setting>& settings,
                       const CostOptions& options, Progress& progress) {
  const auto start = std::chrono::steady_clock::now();
  const auto elapsed = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  CostStudy study;
  study.scene = description.file_name;
  study.content = content_of(description);
  const double budget = options.budget_seconds * kMeasuringShare;
  const auto total = double(settings.size() + 1);
  progress.update("cost", 0, total);
  Reference reference;
  double seconds_a_sample = 0;
  {
    const Scene scene = build_scene(description, progress);
    const RenderReport probe = render_at(scene, kProbeSpp, kReferenceSeed, options).report;
    seconds_a_sample = std::max(probe.seconds, 1e-3) / kProbeSpp;
    if (!options.reference.empty()) {
      const Image given = given_reference(options.reference, description.film.window());
      reference = reference_of(given, given);
    } else {
      const double affordable = kReferenceShare * budget / seconds_a_sample;
      study.reference_spp = std::max(kLeastReferenceSpp, int(std::min(affordable, 1e6)) / 16 * 16);
      const RenderResult first = render_at(scene, study.reference_spp / 2, kReferenceSeed, options);
      const RenderResult second = render_at(scene, study.reference_spp / 2, kReferenceSeed + 1, options);
      reference = reference_of(beauty_of(first), beauty_of(second));
      study.reference_seconds = first.report.seconds + second.report.seconds;
    }
    study.threads = probe.threads;
  }
  const PartPair reference_parts =
      render_parts(description, kReferencePartSpp, kReferenceSeed + 2, options.threads, progress);
  study.reference = reference.mean;
  study.exposure = reference.exposure;
  study.epsilon = reference.metrics.epsilon;
  study.width = study.reference.width;
  study.height = study.reference.height;
  study.reference_rel_mse = noise_rel_mse(reference.pair(), study.epsilon).value;
  const auto needed = [&](int points) {
    return seconds_a_sample * (kFirstSpp * ((1 << points) - 1) + 2 * kPartSpp);
  };
  if (const double least = elapsed() + needed(kFewestPointsInHaste) * double(settings.size());
      least > budget) {
    progress.note(
        fmt::format("{:.0f} s are too few for {} settings of this scene: it would take about {:.0f} s",
                    options.budget_seconds, settings.size(), least));
  }
  for (const Setting& setting : settings) {
    progress.update("cost", double(&setting - settings.data()) + 1, total);
    const double settings_left = total - 1 - double(&setting - settings.data());
    const double each = (budget - elapsed()) / settings_left;
    const int fewest_points = needed(kFewestPoints) <= each ? kFewestPoints : kFewestPointsInHaste;
    if (!study.records.empty() && elapsed() > kMostOverdraft * options.budget_seconds) {
      study.left_out.push_back(fmt::format("{}: no time left", setting.title()));
      continue;
    }
    SceneDesc changed = description;
    try {
      setting.apply(changed, progress);
      reset_peak_memory();
      const double for_ladder = each - 2 * kPartSpp * seconds_a_sample;
      CostRecord record =
          measure(setting, build_scene(changed, progress), reference, for_ladder, fewest_points, options);
      record.peak_memory_bytes = peak_memory_bytes();
      record.parts = bias_by_part(
          render_parts(changed, kPartSpp, changed.seed + kMostPoints + 1, options.threads, progress),
          reference_parts);
      study.records.push_back(std::move(record));
    } catch (const InputError& e) {
      study.left_out.push_back(fmt::format("{}: {}", setting.title(), e.diagnostics().front().text()));
    }
  }
  SPECTRACE_CHECK(!study.records.empty());
  return study;
}

}  // namespace spectrace::cli
