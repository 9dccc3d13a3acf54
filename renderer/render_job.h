// SPDX-License-Identifier: Apache-2.0
// What a kernel is given.
#pragma once

#include <cstdint>

#include "renderer/albedo.h"
#include "renderer/film.h"
#include "renderer/scene.h"

namespace spectrace {

struct RenderJob {
  const Scene& scene;
  std::uint64_t seed = 0;
  const AlbedoTables* albedos = nullptr;  ///< may be null: then albedos are 0
  std::vector<std::size_t> kept_slots;    ///< FilmLayout::kept_slots()
  FilmLayout layout;
};

}  // namespace spectrace
