// SPDX-License-Identifier: Apache-2.0
#include "renderer/render.h"

#include <fmt/core.h>
#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/base/error.h"
#include "core/base/memory.h"

namespace spectrace {

namespace {

constexpr const char* kStage = "rendering";  // what progress is told of
constexpr double kMostTileSeconds = 2;       // a signal, a checkpoint and a time wait for the tiles under way

const Kernel& kernel_for(const Features& needed, const std::string& name) {
  if (name.empty()) {
    return choose_kernel(needed);
  }
  for (const Kernel& kernel : kernels()) {
    if (kernel.name == name && covers(kernel.features, needed)) {
      return kernel;
    }
  }
  throw InternalError(fmt::format("kernel \"{}\" does not exist or does not cover the scene", name));
}

AovSet gathered_aovs(const RenderOptions& options) {
  AovSet aovs = options.aovs;
  aovs.halves |= options.relative_error > 0;  // what the error is told from
  return aovs;
}

std::unique_ptr<const AlbedoTables> make_albedos(const std::vector<Material>& materials, int threads) {
  return tbb::task_arena(threads).execute([&] { return std::make_unique<const AlbedoTables>(materials); });
}

}  // namespace

FilmLayout film_layout(const Scene& scene, const AovSet& aovs) {
  FilmLayout layout{
      .layers = layer_set(required_features(scene, aovs)), .aovs = aovs, .bins = {}, .bin_layers = {}};
  if (const std::optional<SpectralFilmDesc>& spectral = scene.film.spectral) {
    layout.bins = spectral->bins;
    layout.bin_layers = kBeautyLayer;
    if (aovs.lobes && spectral->lobes) {
      layout.bin_layers = layout.bin_layers | LayerSet(Layer::kDiffuse, Layer::kSpecular);
    }
  }
  return layout;
}

Film new_film(const Scene& scene, const RenderOptions& options) {
  const CropWindow window = scene.film.window();
  FilmLayout layout = film_layout(scene, gathered_aovs(options));
  const SampleRange target{options.first, options.first + std::uint64_t(options.spp)};
  require_memory(Film::memory_bytes(window.width, window.height, layout, target), scene.file_name, "/film",
                 fmt::format("{} x {} pixels with these AOVs and bins", window.width, window.height));
  return {window.width, window.height, std::move(layout), target};
}

RenderSession::RenderSession(const Scene& scene, const RenderOptions& options)
    : RenderSession(scene, options, new_film(scene, options)) {}

RenderSession::RenderSession(const Scene& scene, const RenderOptions& options, Film film)
    : scene_(scene),
      options_(options),
      kernel_(
          kernel_for(united(required_features(scene, film.layout().aovs), options.forced), options.kernel)),
      film_(std::move(film)),
      threads_(options.threads > 0 ? options.threads : tbb::this_task_arena::max_concurrency()),
      albedos_(film_.layout().aovs.albedo ? make_albedos(scene.materials, threads_) : nullptr),
      job_{.scene = scene,
           .seed = options.seed,
           .albedos = albedos_.get(),
           .kept_slots = film_.layout().kept_slots(),
           .layout = film_.layout()} {
  SPECTRACE_CHECK(options.spp >= 1 && options.threads >= 0);
  // A pass that was left in its middle is taken up again.
  const auto [begin, end] = film_.ends();
  pass_ = {begin, end - begin};
}

RenderSession::~RenderSession() = default;

/// As many leaves as there are already, so that there is always a whole image, and few passes; no more than
/// the error asked for seems to take, or a tile's time allows. Its length changes no bit.
LeafRange RenderSession::next_pass(std::uint64_t begin) {
  const LeafRange target = film_.target().leaves();
  std::uint64_t most = std::min(target.end() - begin, std::max<std::uint64_t>(1, begin - target.first));
  if (options_.seconds > 0 && leaves_rendered_ > 0) {
    const double affordable = (options_.seconds - seconds_) / (seconds_ / leaves_rendered_);
    if (affordable < 1) return {begin, 0};
    most = std::uint64_t(std::min(double(most), affordable));
  }
  if (leaves_rendered_ > 0) {
    const double tile_seconds = seconds_ * threads_ / (leaves_rendered_ * double(film_.tiles().size()));
    most = std::uint64_t(std::clamp(kMostTileSeconds / tile_seconds, 1.0, double(most)));
  }
  const auto has = double(begin - target.first);
  if (options_.relative_error > 0 && has > 0) {
    const double missing = std::ceil(trend_.samples_for(options_.relative_error) - has);
    most = std::uint64_t(std::clamp(missing, 1.0, double(most)));
  }
  return largest_block(begin, most);
}

/// How many the film will hold in the end: fewer than its target where a time or an error ends the render
/// before; infinity while nothing tells when.
double RenderSession::expected_leaves() const {
  const LeafRange target = film_.target().leaves();
  const auto has = double(pass_.first - target.first);
  std::optional<double> expected;
  const auto end_at = [&](double leaves) { expected = std::min(leaves, expected.value_or(leaves)); };
  if (options_.seconds > 0 && leaves_rendered_ > 0) {
    end_at(has + (options_.seconds - seconds_) / (seconds_ / leaves_rendered_));
  }
  if (options_.relative_error > 0 && trend_.is_known()) end_at(trend_.samples_for(options_.relative_error));
  const bool ends_before = options_.seconds > 0 || options_.relative_error > 0;
  if (ends_before && !expected) return std::numeric_limits<double>::infinity();
  return std::clamp(expected.value_or(double(target.count)), has + double(pass_.count), double(target.count));
}

bool RenderSession::is_good_enough(std::uint64_t leaves) {
  if (options_.relative_error <= 0) return false;
  const double error = film_.relative_error();
  trend_.add(double(leaves), error);
  return error <= options_.relative_error;
}

bool RenderSession::advance(Clock::time_point until, const std::atomic<bool>& stop, Progress& progress) {
  const LeafRange target = film_.target().leaves();
  while (!is_done_) {
    if (pass_.count == 0) {
      const bool has_some = pass_.first > target.first;
      const bool goes_on =
          pass_.first < target.end() && !(has_some && is_good_enough(pass_.first - target.first));
      if (goes_on) pass_ = next_pass(pass_.first);
      is_done_ = pass_.count == 0;
      // Sooner than was thought: the end is told all the same.
      const auto has = double(pass_.first - target.first);
      if (is_done_ && pass_.first < target.end()) progress.update(kStage, has, has);
    } else if (render_pass(until, stop, progress)) {
      pass_ = {pass_.end(), 0};
    } else {
      break;
    }
  }
  return is_done_;
}

/// False: there are tiles left to do.
bool RenderSession::render_pass(Clock::time_point until, const std::atomic<bool>& stop, Progress& progress) {
  const auto start = Clock::now();
  std::vector<std::size_t> left;
  for (std::size_t tile = 0; tile < film_.tiles().size(); ++tile) {
    if (film_.end(tile) < pass_.end()) left.push_back(tile);
  }
  film_.reserve(pass_.end());
  const LeafRange target = film_.target().leaves();
  const SampleRange samples{pass_.first * kLeafSamples,
                            std::min(pass_.end() * kLeafSamples, film_.target().last)};
  // More threads than cores are a user's to ask for; the arena alone would not make them.
  const tbb::global_control limit(
      tbb::global_control::max_allowed_parallelism,
      std::max(std::size_t(threads_),
               tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism)));
  tbb::task_arena arena(threads_);
  const auto tiles = double(film_.tiles().size());
  const double expected = expected_leaves();
  std::atomic<std::size_t> done{film_.tiles().size() - left.size()}, rendered{0};
  const auto render_one = [&](std::size_t tile) {
    thread_local TileSums sums;
    const TileCounts counts = kernel_.render_tile(job_, samples, film_.tiles()[tile], sums, nullptr);
    film_.add(tile, pass_, sums);
    rays_ += counts.rays;
    measured_ += counts.measured;
    extrapolated_ += counts.extrapolated;
    ++rendered;
    const double leaves = double(pass_.first - target.first) + double(pass_.count) * double(++done) / tiles;
    progress.update(kStage, leaves, expected);
  };
  arena.execute([&] {
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, left.size(), 1),
        [&](const tbb::blocked_range<std::size_t>& range) {
          for (std::size_t i = range.begin(); i < range.end(); ++i) {
            if (stop.load(std::memory_order_relaxed) || Clock::now() >= until) return;
            render_one(left[i]);
          }
        },
        tbb::simple_partitioner());
  });
  seconds_ += std::chrono::duration<double>(Clock::now() - start).count();
  leaves_rendered_ += double(pass_.count) * double(rendered) / tiles;
  return done == film_.tiles().size();
}

void RenderSession::finish(Progress& progress) {
  const std::atomic<bool> never{false};
  SPECTRACE_CHECK(advance(Clock::time_point::max(), never, progress));
}

RenderReport RenderSession::report() const {
  const SampleRange target = film_.target();
  const double pixels = double(film_.width()) * double(film_.height());
  return {.kernel = std::string(kernel_.name),
          .effects = list_effects(scene_, film_.layout().aovs, options_.forced, kernel_.features),
          .samples = {target.first, std::min(film_.ends().first * kLeafSamples, target.last)},
          .paths = std::uint64_t(std::llround(
              std::min(leaves_rendered_ * double(kLeafSamples), double(target.count())) * pixels)),
          .rays = rays_,
          .invalid_samples = film_.invalid_samples(),
          .measured_vertices = measured_,
          .extrapolated_share = measured_ > 0 ? double(extrapolated_) / double(measured_) : 0,
          .seconds = seconds_,
          .threads = threads_};
}

RenderResult render(const Scene& scene, const RenderOptions& options, Progress& progress) {
  RenderSession session(scene, options);
  session.finish(progress);
  return {session.film().resolve(), session.report()};
}

}  // namespace spectrace
