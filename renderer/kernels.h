// SPDX-License-Identifier: Apache-2.0
// The compiled kernels, from lean to full, and the choice between them (ADR 0006).
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

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

using RenderTile = void (*)(const Scene& scene, std::uint64_t seed, SampleRange samples, Tile tile,
                            Film& film);

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
