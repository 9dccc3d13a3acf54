// SPDX-License-Identifier: Apache-2.0
#include "renderer/render.h"

#include <fmt/core.h>
#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <chrono>

#include "core/base/error.h"
#include "core/base/version.h"
#include "renderer/kernels.h"

namespace spectrace {

namespace {

constexpr int kTileSize = 16;  // pixels: small enough to share the last tiles out, large enough to amortise

std::vector<Tile> make_tiles(int width, int height) {
  std::vector<Tile> tiles;
  for (int y = 0; y < height; y += kTileSize) {
    for (int x = 0; x < width; x += kTileSize) {
      tiles.push_back({x, y, std::min(x + kTileSize, width), std::min(y + kTileSize, height)});
    }
  }
  return tiles;
}

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

const char* instruction_set() {
#if defined(__AVX512F__)
  return "AVX-512";
#elif defined(__AVX2__)
  return "AVX2";
#elif defined(__SSE4_2__)
  return "SSE4.2";
#elif defined(__SSE2__)
  return "SSE2";
#else
  return "scalar";
#endif
}

std::string join(const std::vector<std::string>& parts) {
  std::string text;
  for (const std::string& part : parts) {
    text += (text.empty() ? "" : "; ") + part;
  }
  return text;
}

}  // namespace

RenderResult render(const Scene& scene, const RenderOptions& options, Progress& progress) {
  SPECTRACE_CHECK(options.spp >= 1 && options.threads >= 0);
  const Features needed = required_features(scene, options.layers);
  const Kernel& kernel = kernel_for(needed, options.kernel);
  const CropWindow window = scene.film.window();
  Film film(window.width, window.height, layer_set(needed));
  const std::vector<Tile> tiles = make_tiles(film.width(), film.height());
  const SampleRange samples{0, std::uint64_t(options.spp)};

  const int threads = options.threads > 0 ? options.threads : tbb::this_task_arena::max_concurrency();
  // More threads than cores are a user's to ask for; the arena alone would not make them.
  const tbb::global_control limit(
      tbb::global_control::max_allowed_parallelism,
      std::max(std::size_t(threads),
               tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism)));
  tbb::task_arena arena(threads);
  std::atomic<std::size_t> done{0};
  std::atomic<std::uint64_t> rays{0}, measured{0}, extrapolated{0};
  const auto start = std::chrono::steady_clock::now();
  arena.execute([&] {
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, tiles.size(), 1),
        [&](const tbb::blocked_range<std::size_t>& range) {
          for (std::size_t i = range.begin(); i < range.end(); ++i) {
            const TileCounts of_tile =
                kernel.render_tile(scene, options.seed, samples, tiles[i], film, nullptr);
            rays += of_tile.rays;
            measured += of_tile.measured;
            extrapolated += of_tile.extrapolated;
            progress.update("rendering", double(++done), double(tiles.size()));
          }
        },
        tbb::simple_partitioner());
  });
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;

  EffectList effects = list_effects(needed, kernel.features);
  RenderResult result;
  result.image = film.resolve();
  result.report = {
      .kernel = std::string(kernel.name),
      .effects_used = std::move(effects.used),
      .effects_skipped = std::move(effects.skipped),
      .paths = std::uint64_t(film.width()) * std::uint64_t(film.height()) * std::uint64_t(options.spp),
      .rays = rays,
      .invalid_samples = film.invalid_samples(),
      .extrapolated_share = measured > 0 ? double(extrapolated) / double(measured) : 0,
      .seconds = elapsed.count(),
      .threads = threads};
  return result;
}

Metadata provenance(const Scene& scene, const RenderOptions& options, const RenderReport& report) {
  const WavelengthRange range = scene.wavelengths.range();
  return {
      {"spectrace:version", std::string(version())},
      {"spectrace:commit", std::string(commit())},
      {"spectrace:sceneFile", scene.file_name},
      {"spectrace:sceneSha256", scene.sha256},
      {"spectrace:materialSha256s", join(scene.material_sha256s)},
      {"spectrace:cropWindow", fmt::format("{} {} {} {} of {} x {}", scene.film.window().x,
                                           scene.film.window().y, scene.film.window().width,
                                           scene.film.window().height, scene.film.width, scene.film.height)},
      {"spectrace:seed", std::to_string(options.seed)},  // text: 64 unsigned bits fit no other attribute
      {"spectrace:spp", std::int64_t(options.spp)},
      {"spectrace:sampleRange", fmt::format("0:{}", options.spp)},
      {"spectrace:seconds", report.seconds},
      {"spectrace:threads", std::int64_t(report.threads)},
      {"spectrace:isa", std::string(instruction_set())},
      {"spectrace:lambdaMinNm", double(range.min_nm)},
      {"spectrace:lambdaMaxNm", double(range.max_nm)},
      {"spectrace:units", std::string("linear sRGB of W.m^-2.sr^-1.nm^-1 weighted by CIE 1931 / 106.857 nm")},
      {"spectrace:kernel", report.kernel},
      {"spectrace:effectsUsed", join(report.effects_used)},
      {"spectrace:effectsSkipped", join(report.effects_skipped)},
      {"spectrace:invalidSamples", std::int64_t(report.invalid_samples)},
      {"spectrace:extrapolatedShare", report.extrapolated_share},
  };
}

}  // namespace spectrace
