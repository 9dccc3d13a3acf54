// SPDX-License-Identifier: Apache-2.0
// From a scene to images.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/image/image.h"
#include "renderer/scene.h"

namespace spectrace {

struct RenderOptions {
  int spp = 64;  ///< samples a pixel, at least 1
  std::uint64_t seed = 0;
  int threads = 0;     ///< 0 = all cores; changes no bit of the image
  bool layers = true;  ///< diffuse, specular, emission and background apart; off: R,G,B alone, the same bits
  std::string kernel{};  ///< name of a profile to use instead of the leanest that covers the scene; for
                         ///< tests: changes no bit of the image. One that does not cover it: InternalError
};

/// What was simulated and what it cost.
struct RenderReport {
  std::string kernel;  ///< name of the chosen profile
  std::vector<std::string> effects_used,
      effects_skipped;  ///< "environment", "dispersion: no dispersive material"
  std::uint64_t paths = 0;
  std::uint64_t rays = 0;             ///< shadow rays included, but for those through masks
  std::uint64_t invalid_samples = 0;  ///< non-finite or negative radiance: dropped
  double extrapolated_share = 0;  ///< of path vertices on measured BRDFs: seen from beyond what was measured
  double seconds = 0;
  int threads = 0;
};

struct RenderResult {
  /// Channels R,G,B, diffuse.R,G,B, specular.R,G,B, emission.R,G,B, background.R,G,B,
  /// diagnostics.invalid: linear sRGB as in core/spectra/color.h. beauty = the sum of the four layers. Where
  /// a material tells them apart also specular_fresnel, specular_diffraction, specular_residual, whose sum is
  /// specular; the latter two are signed.
  Image image;
  RenderReport report;
};

RenderResult render(const Scene& scene, const RenderOptions& options, Progress& progress);

/// Provenance for the EXR header: docs/conventions.md, names `spectrace:*`.
Metadata provenance(const Scene& scene, const RenderOptions& options, const RenderReport& report);

}  // namespace spectrace
