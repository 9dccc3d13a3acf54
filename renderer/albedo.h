// SPDX-License-Identifier: Apache-2.0
// What share of white light from all around each lobe of a material sends to the viewer, as a colour: what
// denoisers want to know of a surface, without the noise of light or wavelengths.
#pragma once

#include <cstddef>
#include <unordered_map>
#include <vector>

#include "core/spectra/spectrum.h"
#include "materials/material.h"

namespace spectrace {

/// Hemispherical-directional reflectance (and transmittance, of what is seen through) by lobe under D65, as
/// linear sRGB in [0, 1].
struct LobeAlbedo {
  Rgb diffuse{}, specular{};
};

/// Tables by the cosine of the viewer for every part of every material and each spectrum of its texture; what
/// images vary is looked up where it is asked for. An anisotropic material's is its mean over the azimuth.
/// Immutable.
class AlbedoTables {
 public:
  /// `materials` must stay where they are. Takes tens of milliseconds a material.
  explicit AlbedoTables(const std::vector<Material>& materials);

  /// `wo` in the shading frame, as for evaluate(); the wavelengths of `at` are of no concern.
  [[nodiscard]] LobeAlbedo at(const Material& material, Vec3 wo, const ShadingPoint& at) const;

 private:
  /// Seen from one side: nodes equally spaced in |cosθ|.
  using Table = std::vector<LobeAlbedo>;
  struct Sides {
    Table front, back;
  };
  void add(const Material& part);
  [[nodiscard]] LobeAlbedo look_up(const Material& part, std::size_t palette_index, Vec3 wo) const;

  std::unordered_map<const Material*, std::vector<Sides>> tables_;  // by the palette of the texture
};

}  // namespace spectrace
