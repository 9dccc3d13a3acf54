// SPDX-License-Identifier: Apache-2.0
// The compiled kernels, from lean to full, and the choice between them (ADR 0006).
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "renderer/accel_embree.h"
#include "renderer/features.h"
#include "renderer/film.h"
#include "renderer/scene.h"

namespace spectrace {

/// Pixels [x0, x1) x [y0, y1).
struct Tile {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

/// Samples [first, last) of each pixel.
struct SampleRange {
  std::uint64_t first = 0, last = 0;
};

/// What rendering a tile came to.
struct TileCounts {
  std::uint64_t rays = 0;  ///< shadow rays included, but for those through masks
  /// Vertices on measured BRDFs, and those of them seen from beyond the last measured elevation.
  std::uint64_t measured = 0, extrapolated = 0;
};

/// Rays as a kernel has traced them, to be traced again (renderer/throughput.h).
struct TracedPacket {
  RayPacket rays;
  PacketMask active = 0;
  bool coherent = false, is_shadow = false;
};
using TraceLog = std::vector<TracedPacket>;

/// `tile` in pixels of the film, which holds the scene's crop window. `log`: may be null.
using RenderTile = TileCounts (*)(const Scene& scene, std::uint64_t seed, SampleRange samples, Tile tile,
                                  Film& film, TraceLog* log);

struct Kernel {
  std::string_view name;
  Features features;
  RenderTile render_tile = nullptr;
};

/// All of them, lean to full; the last has every feature.
[[nodiscard]] std::span<const Kernel> kernels();
/// The first that covers `needed`.
[[nodiscard]] const Kernel& choose_kernel(const Features& needed);

}  // namespace spectrace
