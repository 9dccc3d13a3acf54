// SPDX-License-Identifier: Apache-2.0
// How fast a scene renders, and where the time goes: the rays of a render are traced again by themselves.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "core/base/progress.h"
#include "renderer/aovs.h"
#include "renderer/scene.h"

namespace spectrace {

struct ThroughputOptions {
  int spp = 64;     ///< samples a pixel, at least 1
  int threads = 0;  ///< of the second render; 0 = all cores
  AovSet aovs;
};

/// Seconds of one thread unless said otherwise.
struct Throughput {
  std::string kernel;
  std::uint64_t paths = 0, rays = 0;  ///< of one render; shadow rays included
  std::uint64_t triangles = 0;        ///< in memory: those of instances count once
  double seconds = 0;
  int threads = 0;
  double seconds_of_threads = 0;      ///< the same render on `threads` threads
  std::size_t peak_memory_bytes = 0;  ///< of loading and rendering; 0 where the system does not tell
  /// Of `seconds`, from a part of the paths done again: tracing their rays; drawing their random numbers and
  /// wavelengths; turning the film into an image. What remains is shading.
  double traversal = 0, sampling = 0, film = 0;
  /// The same rays one at a time, as a program without packets would trace them [rays/s].
  double single_rays_per_second = 0;

  [[nodiscard]] double shading() const { return seconds - traversal - sampling - film; }
  [[nodiscard]] double rays_per_second() const { return double(rays) / seconds; }
  /// What Embree alone does with them, by packets or one at a time, whichever is faster.
  [[nodiscard]] double raw_rays_per_second() const;
};

[[nodiscard]] Throughput measure_throughput(const Scene& scene, const ThroughputOptions& options,
                                            Progress& progress);

}  // namespace spectrace
