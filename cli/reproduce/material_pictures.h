// SPDX-License-Identifier: Apache-2.0
// Pictures of one material in all its descriptions, on the same random paths.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/image/image.h"
#include "materials/paired_brdf.h"
#include "renderer/scene.h"

namespace spectrace::cli {

/// What the material reflects: no sky behind it, whose pixels every description has right.
struct Picture {
  std::string name;
  Image layers;  ///< R, G, B, and diffuse, specular, specular_fresnel, ... as far as the description has them
  std::int64_t invalid_samples = 0;

  [[nodiscard]] Image rgb(const std::string& layer = "") const;  ///< R, G, B
  [[nodiscard]] bool has(const std::string& layer) const;
};

struct PictureOptions {
  int spp = 64;
  std::uint64_t seed = 0;
  int threads = 0;
};

/// `scene` as write_reference_scene() makes it; its one material is replaced.
Picture take_picture(std::string name, Scene& scene, PairedBrdf::Values values,
                     const SeparatedBrdf& directions, const PictureOptions& options);

}  // namespace spectrace::cli
