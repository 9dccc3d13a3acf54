// SPDX-License-Identifier: Apache-2.0
// In which lobes and wavelengths a setting is off.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/image/error_model.h"
#include "core/image/image.h"
#include "renderer/scene_desc.h"

namespace spectrace::cli {

/// A lobe, or a band of wavelengths of the beauty.
struct Part {
  std::string name;  ///< "diffuse", "specular", "360-477 nm"
  Image image;
};
/// Two renders of one setting that share no samples.
using PartPair = std::array<std::vector<Part>, 2>;

/// Bands of equal width over the scene's range; none where the scene has bins of its own.
inline constexpr std::size_t kBands = 4;

[[nodiscard]] PartPair render_parts(SceneDesc scene, int spp, std::uint64_t seed, int threads,
                                    Progress& progress);

struct PartBias {
  std::string name;
  Estimate bias;  ///< of relMSE, with kRelativeEpsilon of the part
};
/// Of what both have, by name.
[[nodiscard]] std::vector<PartBias> bias_by_part(const PartPair& test, const PartPair& reference);

}  // namespace spectrace::cli
