// SPDX-License-Identifier: Apache-2.0
// What is written into the header of every image, so that it says where it comes from.
#pragma once

#include "core/image/image.h"
#include "renderer/render.h"

namespace spectrace {

/// docs/conventions.md, names `spectrace:*`.
[[nodiscard]] Metadata provenance(const Scene& scene, const RenderOptions& options,
                                  const RenderReport& report);
/// Of an image that goes on with another, or is joined of both: `header`, but for what the render of both
/// took and met. Seconds and vertices add up; threads are the most that one of them had; instruction sets are
/// named each.
[[nodiscard]] Metadata joined_provenance(Metadata header, const Metadata& other);
/// The same for the spectral images beside it, with what Fichet, Pacanowski and Wilkie (JCGT 10(3), 2021) ask
/// for.
[[nodiscard]] Metadata spectral_provenance(Metadata of_image, const SpectralBins& bins);

}  // namespace spectrace
