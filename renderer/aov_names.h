// SPDX-License-Identifier: Apache-2.0
// Names of channels as other programs use them.
#pragma once

#include <cstdint>

#include "core/image/image.h"

namespace spectrace {

enum class AovNames : std::uint8_t {
  kArnold,   ///< ours: diffuse_direct.R, ...
  kBlender,  ///< ViewLayer.DiffDir.R, ...: light over colour where there is an albedo, as Blender's
             ///< compositor multiplies it again
  kKpcn,     ///< diffuseVariance.R, ...: Bako et al. 2017, "Kernel-Predicting Convolutional Networks for
             ///< Denoising Monte Carlo Renderings"
};

/// Renames the channels of a render; those without a name there keep theirs.
void use_names(AovNames names, Image& image);

}  // namespace spectrace
