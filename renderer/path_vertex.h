// SPDX-License-Identifier: Apache-2.0
// A vertex of a path: the surface met, the frame its BSDF is evaluated in, and which of its sides faces whom.
#pragma once

#include <algorithm>

#include "core/math/sampler.h"
#include "materials/material.h"
#include "renderer/features.h"
#include "renderer/lights.h"
#include "renderer/surface.h"

namespace spectrace {

/// Shading normals are bent until the viewer stands this far above their horizon (cosine), or as far as above
/// the true one: interpolated normals that face away would render black rims (hard case H17).
inline constexpr Float kMinShadingCosine = Float(1e-3);

template <Features kFeatures>
struct PathVertex {
  /// Materials with two sides of their own may be met from behind; all others are turned to face the viewer.
  static constexpr bool kMayKeepSides = kFeatures.transmission || kFeatures.nested;

  SurfacePoint point;  ///< normal_g on the frame's side
  Frame frame;
  Vec3 wo;  ///< local
  const Material& material;
  ShadingPoint at;
  VertexNumbers numbers;

  /// `wo`: towards the viewer, in the world.
  PathVertex(const SurfacePoint& met, Vec3 wo_world, const Material& met_material, const ShadingPoint& met_at,
             const VertexNumbers& met_numbers)
      : point(facing(met, wo_world, met_material)),
        frame(frame_along(point.normal_s, point.tangent)),
        wo(frame.to_local(wo_world)),
        material(met_material),
        at(met_at),
        numbers(met_numbers) {}

  /// Light may not pass a surface because its shading normal is bent: both normals must agree on the side.
  [[nodiscard]] bool sides_agree(Vec3 wi_world, Vec3 wi_local) const {
    return (dot(wi_world, point.normal_g) > 0) == (wi_local.z > 0);
  }

  [[nodiscard]] BsdfRandom bsdf_numbers() const { return {numbers.lobe, numbers.bsdf}; }

  /// What lights are chosen for: the same for the choice and for the weight of light met by chance.
  [[nodiscard]] Receiver receiver() const {
    Receiver receiver{point.position, frame.n};
    if constexpr (kMayKeepSides) {
      if (keeps_sides(material)) receiver.normal = {};
    }
    return receiver;
  }

 private:
  static SurfacePoint facing(SurfacePoint point, Vec3 wo, [[maybe_unused]] const Material& material) {
    bool flip = dot(wo, point.normal_g) < 0;
    if constexpr (kMayKeepSides) flip = flip && !keeps_sides(material);
    if (flip) {
      point.normal_g = -point.normal_g;
      point.normal_s = -point.normal_s;
    }
    const Float true_cosine = dot(wo, point.normal_g);
    const Float side = true_cosine < 0 ? Float(-1) : Float(1);
    const Float cosine = dot(wo, point.normal_s) * side;
    const Float wanted = std::min(kMinShadingCosine, true_cosine * side);
    if (cosine < wanted) {
      point.normal_s = normalize(point.normal_s + wo * (side * (wanted - cosine)));
    }
    return point;
  }
};

}  // namespace spectrace
