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
#include "renderer/render_job.h"

namespace spectrace {

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

/// Renders samples of each pixel of a tile, in pixels of the film, which holds the scene's crop window. The
/// samples' leaves must be one block. `log`: may be null.
using RenderTile = TileCounts (*)(const RenderJob& job, SampleRange samples, Tile tile, TileSums& sums,
                                  TraceLog* log);

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
