// SPDX-License-Identifier: Apache-2.0
#include "cli/cost/measurement.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
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
/// The rest is left to write the report in, and for what takes longer than it seemed.
constexpr double kMeasuringShare = 0.9;
/// Of the budget: settings that would end later are left out.
constexpr double kMostOverdraft = 1.05;
/// Smaller pictures would be another scene.
constexpr int kLeastSide = 48;
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

/// `most_seconds`: fewer samples where they would take longer; 0: whatever they take.
RenderResult render_at(const Scene& scene, int spp, std::uint64_t seed, const CostOptions& options,
                       double most_seconds = 0) {
  SilentProgress silent;
  return render(
      scene, {.spp = spp, .seed = seed, .threads = options.threads, .aovs = kNoAovs, .seconds = most_seconds},
      silent);
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
  for (std::size_t i = 0; i < given.data.size(); ++i) {
    if (std::isfinite(given.data[i])) continue;
    const int pixel = int(i / given.channels.size());
    throw InputError(
        file, "",
        fmt::format("is not finite in channel {} of pixel ({}, {})",
                    given.channels[i % given.channels.size()], pixel % given.width, pixel / given.width));
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

/// What a ladder of so many points takes, and the parts by lobe and band [samples a pixel].
constexpr int ladder_spp(int points) { return kFirstSpp * ((1 << points) - 1) + 2 * kPartSpp; }

/// A study under way: what it has to do is cut to the time that is left.
class Measurement {
 public:
  Measurement(const SceneDesc& scene, const std::vector<Setting>& settings, const CostOptions& options,
              Progress& progress)
      : scene_(scene), settings_(settings), options_(options), progress_(progress) {
    study_.scene = scene.file_name;
    study_.content = content_of(scene);
    study_.scene_width = scene.film.window().width;
    study_.scene_height = scene.film.window().height;
  }

  CostStudy run() {
    const double total = double(settings_.size()) + 2;
    progress_.update("cost", 0, total);
    for (const Setting& setting : settings_) prepare(setting);
    progress_.update("cost", 1, total);
    probe();
    if (options_.reference.empty() && shrink()) probe();
    make_reference();
    for (std::size_t i = 0; i < scenes_.size(); ++i) {
      progress_.update("cost", double(i + 2), total);
      measure_setting(scenes_[i], scenes_.size() - i);
    }
    SPECTRACE_CHECK(!study_.records.empty());
    return std::move(study_);
  }

 private:
  struct SettingScene {
    const Setting* setting = nullptr;
    SceneDesc scene;
  };

  /// Before anything is measured, for it may take long: separations are made here.
  void prepare(const Setting& setting) {
    SettingScene prepared{&setting, scene_};
    try {
      setting.apply(prepared.scene, progress_);
      scenes_.push_back(std::move(prepared));
    } catch (const InputError& e) {
      leave_out(setting, e.diagnostics().front().text());
    }
  }
  void leave_out(const Setting& setting, const std::string& reason) {
    study_.left_out.push_back(fmt::format("{}: {}", setting.title(), reason));
  }

  [[nodiscard]] double left() const {
    const double elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    return options_.budget_seconds * kMeasuringShare - elapsed;
  }
  [[nodiscard]] double ladder_seconds(int points) const { return seconds_a_sample_ * ladder_spp(points); }

  void probe() {
    const Scene scene = build_scene(scene_, progress_);
    const RenderReport report = render_at(scene, kProbeSpp, kReferenceSeed, options_).report;
    seconds_a_sample_ = std::max(report.seconds, 1e-3) / kProbeSpp;
    study_.threads = report.threads;
    study_.effects = report.effects;
  }

  /// Fewer pixels where there is no time for all: what is measured is a mean over pixels. True: there are.
  bool shrink() {
    const double wanted =
        ladder_seconds(kFewestPoints) * double(scenes_.size()) + seconds_a_sample_ * 2 * kReferencePartSpp;
    const double affordable = std::max(0.0, (1 - kReferenceShare) * left());
    if (wanted <= affordable || scene_.film.crop) return false;
    const double factor = std::sqrt(affordable / wanted);
    FilmDesc& film = scene_.film;
    const auto shrunk = [&](int side) {
      return std::clamp(int(side * factor), std::min(side, kLeastSide), side);
    };
    film.width = shrunk(film.width);
    film.height = shrunk(film.height);
    progress_.note(fmt::format("{:.0f} s are too few for {} settings at {} x {} pixels: {} x {} are taken",
                               options_.budget_seconds, scenes_.size(), study_.scene_width,
                               study_.scene_height, film.width, film.height));
    return true;
  }

  void make_reference() {
    if (!options_.reference.empty()) {
      const Image given = given_reference(options_.reference, scene_.film.window());
      reference_ = reference_of(given, given);
    } else {
      render_reference();
    }
    if (std::all_of(reference_.mean.data.begin(), reference_.mean.data.end(),
                    [](float x) { return x == 0; })) {
      throw InputError(scene_.file_name, "", "is black: there is no error to measure");
    }
    parts_ = render_parts(scene_, kReferencePartSpp, kReferenceSeed + 2, options_.threads, progress_);
    study_.reference = reference_.mean;
    study_.exposure = reference_.exposure;
    study_.epsilon = reference_.metrics.epsilon;
    study_.width = study_.reference.width;
    study_.height = study_.reference.height;
    study_.reference_rel_mse = noise_rel_mse(reference_.pair(), study_.epsilon).value;
  }

  void render_reference() {
    const double seconds = kReferenceShare * left();
    const double affordable = std::min(seconds / seconds_a_sample_, 1e6);
    const int wanted = std::max(kLeastReferenceSpp, int(affordable) / 16 * 16) / 2;
    const Scene scene = build_scene(scene_, progress_);
    const RenderResult first = render_at(scene, wanted, kReferenceSeed, options_, seconds / 2);
    const int spp = int(first.report.samples.count());
    const RenderResult second = render_at(scene, spp, kReferenceSeed + 1, options_);
    reference_ = reference_of(beauty_of(first), beauty_of(second));
    study_.reference_spp = 2 * spp;
    study_.reference_seconds = first.report.seconds + second.report.seconds;
    // Other programs may have come in between.
    seconds_a_sample_ = std::max(seconds_a_sample_, study_.reference_seconds / study_.reference_spp);
  }

  void measure_setting(SettingScene& prepared, std::size_t settings_left) {
    const Setting& setting = *prepared.setting;
    SceneDesc& scene = prepared.scene;
    scene.film.width = scene_.film.width;
    scene.film.height = scene_.film.height;
    const double each = left() / double(settings_left);
    const int fewest_points = ladder_seconds(kFewestPoints) <= each ? kFewestPoints : kFewestPointsInHaste;
    const double overdraft = (kMostOverdraft - kMeasuringShare) * options_.budget_seconds;
    if (!study_.records.empty() && left() + overdraft < ladder_seconds(kFewestPointsInHaste)) {
      leave_out(setting, "no time left");
      return;
    }
    try {
      reset_peak_memory();
      const double for_ladder = each - 2 * kPartSpp * seconds_a_sample_;
      CostRecord record =
          measure(setting, build_scene(scene, progress_), reference_, for_ladder, fewest_points, options_);
      record.peak_memory_bytes = peak_memory_bytes();
      record.parts = bias_by_part(
          render_parts(scene, kPartSpp, scene.seed + kMostPoints + 1, options_.threads, progress_), parts_);
      study_.records.push_back(std::move(record));
    } catch (const InputError& e) {
      leave_out(setting, e.diagnostics().front().text());
    }
  }

  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  SceneDesc scene_;
  const std::vector<Setting>& settings_;
  const CostOptions& options_;
  Progress& progress_;
  std::vector<SettingScene> scenes_;
  double seconds_a_sample_ = 0;
  Reference reference_;
  PartPair parts_;
  CostStudy study_;
};

}  // namespace

CostStudy measure_cost(const SceneDesc& scene, const std::vector<Setting>& settings,
                       const CostOptions& options, Progress& progress) {
  return Measurement(scene, settings, options, progress).run();
}

}  // namespace spectrace::cli
