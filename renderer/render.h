// SPDX-License-Identifier: Apache-2.0
// From a scene to images, at once or bit by bit.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/image/image.h"
#include "renderer/error_trend.h"
#include "renderer/film.h"
#include "renderer/kernels.h"
#include "renderer/scene.h"

namespace spectrace {

struct RenderOptions {
  int spp = 64;  ///< samples a pixel, at least 1
  std::uint64_t seed = 0;
  int threads = 0;          ///< 0 = all cores; changes no bit of the image
  AovSet aovs = kLobeAovs;  ///< what the image holds beside the beauty, of which no bit changes
  std::string kernel{};     ///< name of a profile to use instead of the leanest that covers the scene; for
                            ///< tests: changes no bit of the image. One that does not cover it: InternalError
  Features forced{};        ///< effects to simulate though the scene calls for none; changes no bit either
  std::uint64_t first = 0;  ///< samples [first, first + spp) are taken; a multiple of kLeafSamples
  double seconds = 0;       ///< > 0: stop when they have passed, if spp is not reached before
  double relative_error = 0;  ///< > 0: stop at this error of the image (Film::relative_error)
};

/// What was simulated and what it cost.
struct RenderReport {
  std::string kernel;  ///< name of the chosen profile
  EffectList effects;
  SampleRange samples;  ///< that every pixel has
  std::uint64_t paths = 0;
  std::uint64_t rays = 0;               ///< shadow rays included, but for those through masks
  std::uint64_t invalid_samples = 0;    ///< non-finite or negative radiance: dropped
  std::uint64_t measured_vertices = 0;  ///< of paths, on measured BRDFs
  double extrapolated_share = 0;        ///< of those: seen from beyond what was measured
  double seconds = 0;                   ///< of rendering, in this process
  int threads = 0;
};

struct RenderResult {
  /// R,G,B and, by default, diffuse.R,G,B, specular.R,G,B, emission.R,G,B, background.R,G,B,
  /// diagnostics.invalid: linear sRGB as in core/spectra/color.h; everything else in docs/aovs.md.
  Image image;
  RenderReport report;
};

/// What the film of a scene keeps with these AOVs.
[[nodiscard]] FilmLayout film_layout(const Scene& scene, const AovSet& aovs);

/// An empty one: of the scene's window, for the samples asked for. Throws InputError where it would come to
/// hold more memory than there is.
[[nodiscard]] Film new_film(const Scene& scene, const RenderOptions& options);

/// A render that can be watched, stopped and gone on with.
class RenderSession {
 public:
  using Clock = std::chrono::steady_clock;

  /// The scene must outlive it.
  RenderSession(const Scene& scene, const RenderOptions& options);
  /// Goes on with a film of the same scene, seed, layout and first sample: checked by who read it.
  RenderSession(const Scene& scene, const RenderOptions& options, Film film);
  ~RenderSession();
  RenderSession(const RenderSession&) = delete;
  RenderSession& operator=(const RenderSession&) = delete;

  /// Renders until all is done, the time has come or `stop` is set; then tiles under way are finished. True:
  /// done.
  bool advance(Clock::time_point until, const std::atomic<bool>& stop, Progress& progress);
  /// All there is to do.
  void finish(Progress& progress);

  [[nodiscard]] const Film& film() const { return film_; }
  [[nodiscard]] RenderReport report() const;

 private:
  [[nodiscard]] LeafRange next_pass(std::uint64_t begin);
  [[nodiscard]] bool is_good_enough(std::uint64_t leaves);
  [[nodiscard]] double expected_leaves() const;
  bool render_pass(Clock::time_point until, const std::atomic<bool>& stop, Progress& progress);

  const Scene& scene_;
  RenderOptions options_;
  const Kernel& kernel_;
  Film film_;
  int threads_;
  std::unique_ptr<const AlbedoTables> albedos_;
  RenderJob job_;
  LeafRange pass_;  // that is under way, if its count is not 0
  bool is_done_ = false;
  ErrorTrend trend_;  // of the image's error over the leaves it has, where one is asked for
  double seconds_ = 0, leaves_rendered_ = 0;  // by this process, leaves of the whole image
  std::atomic<std::uint64_t> rays_{0}, measured_{0}, extrapolated_{0};
};

RenderResult render(const Scene& scene, const RenderOptions& options, Progress& progress);

}  // namespace spectrace
