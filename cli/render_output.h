// SPDX-License-Identifier: Apache-2.0
// The files a film becomes.
#pragma once

#include <filesystem>

#include "renderer/aov_names.h"
#include "renderer/film.h"

namespace spectrace::cli {

struct RenderOutput {
  std::filesystem::path file;  ///< .exr; the others are named after it
  AovNames names = AovNames::kArnold;
  double exposure = 1;      ///< of PNGs
  bool layer_pngs = false;  ///< also of the diffuse and the specular layer
};

/// out.exr and out.png; out.spectral.exr, out.diffuse.spectral.exr and out.specular.spectral.exr where the
/// film has bins.
void write_images(const RenderOutput& output, const Film& film, const Metadata& metadata);
/// out.partial
[[nodiscard]] std::filesystem::path partial_file(const RenderOutput& output);

}  // namespace spectrace::cli
