// SPDX-License-Identifier: Apache-2.0
// All lights of a scene and the choice between them.
#pragma once

#include <optional>
#include <variant>
#include <vector>

#include "core/spectra/spectrum.h"
#include "renderer/area_light.h"
#include "renderer/environment.h"
#include "renderer/light_tree.h"
#include "renderer/surface.h"

namespace spectrace {

struct PointLight {
  Vec3 position;
  Spectrum intensity;  ///< [W·sr⁻¹·nm⁻¹]
};
/// Full intensity up to an angle from the axis, none beyond a larger one, between them the cubic smoothstep
/// in the cosine that pbrt-v4 has (Pharr, Jakob, Humphreys 2023, sec. 12.2.1).
struct SpotLight {
  Vec3 position;
  Vec3 axis;                 ///< unit, away from the light
  Spectrum intensity;        ///< on the axis [W·sr⁻¹·nm⁻¹]
  Float full_drop, no_drop;  ///< 1 - cosine of the two angles, 0 <= full_drop <= no_drop

  /// In [0, 1]; `way` is unit, away from the light.
  [[nodiscard]] Float share_towards(Vec3 way) const {
    // |a - b|² / 2 is 1 - cosine without cancellation: cones may be narrower than a degree.
    const Float drop = length_squared(way - axis) / 2;
    if (drop <= full_drop) return 1;
    if (drop >= no_drop) return 0;
    const Float t = (no_drop - drop) / (no_drop - full_drop);
    return t * t * (3 - 2 * t);
  }
};
struct DirectionalLight {
  Vec3 to_light;        ///< unit
  Spectrum irradiance;  ///< [W·m⁻²·nm⁻¹] on a surface facing it
};
using DeltaLight = std::variant<PointLight, SpotLight, DirectionalLight>;

/// Shadow rays stop short of the light's surface by 16 steps of float rounding of their length.
inline constexpr Float kShadowEnd = 1 - 16 * kFloatRounding;

/// Radiance arriving at a point from one light; divide by `pdf`.
struct LightSample {
  Vec3 wi;                   ///< unit, towards the light
  std::optional<Vec3> end;   ///< of the shadow ray; none: infinitely far
  SampledSpectrum radiance;  ///< delta lights: intensity / distance², irradiance
  Float pdf = 0;             ///< > 0; [1/sr], or 1 for a delta light. The choice of the light is not in it

  [[nodiscard]] Ray shadow_ray(Vec3 origin) const {
    return end ? Ray{origin, *end - origin, kShadowEnd} : Ray{origin, wi};
  }
};

/// Immutable. Lights are numbered: area lights first, in order, then delta lights, then the environment.
class Lights {
 public:
  struct AreaLight {
    LightShape shape;
    std::uint32_t emission = 0;  ///< into `emissions`
  };

  Lights() = default;
  /// `groups`: how many consecutive area lights make one emitter (a mesh). Powers are averaged over
  /// `observer`, what a pixel sees of each wavelength; `scene_radius` [m] gives distant lights a power.
  Lights(std::vector<AreaLight> area, const std::vector<std::uint32_t>& groups,
         std::vector<Spectrum> emissions, std::vector<DeltaLight> delta,
         std::optional<Environment> environment, const WavelengthDistribution& observer, Float scene_radius);

  using Choice = LightTree::Choice;
  /// By what each light is estimated to send to the receiver, and for a share by a table that knows no place:
  /// half of that equal between emitters, so that no light starves, half by their power. `u` in [0, 1).
  /// Nothing where there is no light, or none that the number leads to can light the receiver.
  [[nodiscard]] std::optional<Choice> choose(const Receiver& receiver, Float u) const;
  /// Of choose() returning `light`: the same bits. Above 0 for all lights with power, but for what an
  /// environment leaves to BSDF sampling.
  [[nodiscard]] Float probability(std::uint32_t light, const Receiver& receiver) const;

  /// Of all lights [W/nm], distant ones by what of them the scene catches.
  [[nodiscard]] double power(double lambda_nm) const;

  [[nodiscard]] bool is_area(std::uint32_t light) const { return light < area_.size(); }
  [[nodiscard]] bool is_environment(std::uint32_t light) const {
    return environment_ && light == environment_index();
  }
  [[nodiscard]] std::optional<LightPoint> sample_area(std::uint32_t light, Vec3 from, Vec2 u) const {
    return sample_light(area_[light].shape, from, u);
  }
  [[nodiscard]] std::optional<LightSample> sample_delta(std::uint32_t light, Vec3 from,
                                                        const SampledWavelengths& lambda) const;
  [[nodiscard]] std::optional<LightSample> sample_environment(Vec2 u, const SampledWavelengths& lambda) const;

  /// Radiance of an area light's front; many lights may share one.
  [[nodiscard]] const Spectrum& emission(std::uint32_t area_light) const {
    return emissions_[area_[area_light].emission];
  }
  [[nodiscard]] const LightShape& shape(std::uint32_t area_light) const { return area_[area_light].shape; }
  [[nodiscard]] const std::optional<Environment>& environment() const { return environment_; }
  [[nodiscard]] std::uint32_t environment_index() const {
    return std::uint32_t(area_.size() + delta_.size());
  }

  [[nodiscard]] std::size_t area_count() const { return area_.size(); }
  [[nodiscard]] std::size_t delta_count() const { return delta_.size(); }

 private:
  /// A light without a place.
  struct Distant {
    std::uint32_t light = 0;
    Vec3 to_light;         // zero: from all around
    float irradiance = 0;  // on a surface that faces it, in the tree's unit
  };
  void build_tree(const WavelengthDistribution& observer);
  void add_distant(const WavelengthDistribution& observer);
  [[nodiscard]] std::optional<std::uint32_t> choose_from_table(Float u) const;
  [[nodiscard]] Choice choose_by_estimate(const Receiver& receiver, Float u) const;
  /// All that is estimated to reach a receiver; `cut` of the tree.
  [[nodiscard]] Float total(const Receiver& receiver, const LightTree::Cut& cut) const;
  [[nodiscard]] Float joint(Float table, Float estimate) const;
  [[nodiscard]] Float estimate_share(std::uint32_t light, const Receiver& receiver) const;

  [[nodiscard]] double power_of(const DeltaLight& light, double lambda_nm) const;
  [[nodiscard]] double power_of_environment(double lambda_nm) const;

  std::vector<AreaLight> area_;
  std::vector<Spectrum> emissions_;
  std::vector<DeltaLight> delta_;
  std::optional<Environment> environment_;
  std::vector<double> emission_area_;  // by emission
  double scene_disk_ = 0;              // what the scene shows a distant light
  std::vector<Float> probability_;     // of the table, by light
  std::vector<double> cumulative_;     // by light; last 1
  Float table_share_ = 1;
  LightTree tree_;  // all lights with a place
  std::vector<Distant> distant_;
};

}  // namespace spectrace
