// SPDX-License-Identifier: Apache-2.0
// The effects a kernel simulates: a template argument, so that what a scene does not need costs nothing (ADR
// 0006).
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/aovs.h"
#include "renderer/layers.h"
#include "renderer/scene.h"

namespace spectrace {

/// One flag an effect. A kernel may leave out what a scene does not have; that changes no bit of its image.
struct Features {
  bool depth_of_field = false;
  bool indirect = false;  ///< more than one bounce
  bool area_lights = false;
  bool delta_lights = false;  ///< point, spot and directional
  bool environment = false;
  bool delta_lobes = false;  ///< mirrors and smooth glass
  bool transmission = false;
  bool dispersion = false;
  bool textures = false;
  bool nested = false;  ///< materials made of others: sides, mixes, masks, normal maps
  bool instances = false;
  bool lobe_layers = false;     ///< diffuse, specular, emission, background apart
  bool specular_parts = false;  ///< and within specular: Fresnel part, diffraction effect, residual
  bool more_aovs = false;       ///< direct light apart, halves, variances, what the first hit looks like
  bool spectral_film = false;

  friend constexpr bool operator==(const Features&, const Features&) = default;
};

/// For lists, messages and the command line: flag, name there, name, and why it is used or left out.
struct FeatureInfo {
  bool Features::*flag;
  std::string_view id;
  std::string_view name;
  std::string_view present;
  std::string_view missing;
};
inline constexpr std::array<FeatureInfo, 15> kFeatureInfos{{
    {&Features::indirect, "indirect-light", "indirect light", "max_depth is above 1",
     "max_depth is at most 1"},
    {&Features::area_lights, "area-lights", "area lights", "a shape emits", "no shape emits"},
    {&Features::delta_lights, "delta-lights", "point, spot and directional lights", "in the scene",
     "none in the scene"},
    {&Features::environment, "environment", "environment", "in the scene", "none in the scene"},
    {&Features::delta_lobes, "delta-lobes", "mirrors and smooth glass", "in the scene", "no such material"},
    {&Features::transmission, "transmission", "transmission", "light goes through a material",
     "no transmitting material"},
    {&Features::dispersion, "dispersion", "dispersion", "refraction varies with wavelength",
     "no material's refraction varies with wavelength"},
    {&Features::textures, "textures", "textures", "a material varies over its surface",
     "no material varies over its surface"},
    {&Features::nested, "nested-materials", "mixes, masks, normal maps, two-sided materials",
     "a material is made of others", "no material is made of others"},
    {&Features::instances, "instances", "instances", "in the scene", "none in the scene"},
    {&Features::lobe_layers, "lobe-layers", "layers by lobe", "asked for", "not asked for"},
    {&Features::specular_parts, "specular-parts", "parts of the specular layer",
     "asked for, and a separated material has them", "not asked for, or no separated material that has them"},
    {&Features::more_aovs, "more-aovs", "AOVs beyond the lobes", "asked for", "not asked for"},
    {&Features::spectral_film, "spectral-film", "spectral film", "asked for", "not asked for"},
    {&Features::depth_of_field, "depth-of-field", "depth of field", "the camera has a lens",
     "the camera has no lens"},
}};

/// Everything on.
constexpr Features all_features() {
  Features f;
  for (const FeatureInfo& info : kFeatureInfos) {
    f.*info.flag = true;
  }
  return f;
}

/// Has `kernel` every flag that `needed` has?
constexpr bool covers(const Features& kernel, const Features& needed) {
  for (const FeatureInfo& info : kFeatureInfos) {
    if (needed.*info.flag && !(kernel.*info.flag)) {
      return false;
    }
  }
  return true;
}

/// The layers a kernel gathers.
constexpr LayerSet layer_set(const Features& features) {
  LayerSet layers = kBeautyLayer;
  if (features.lobe_layers) layers = layers | kLobeLayers;
  if (features.specular_parts) layers = layers | kSpecularParts;
  if (features.more_aovs && features.lobe_layers) layers = layers | kDirectLayers;
  return layers;
}

/// It, or a part of it, varies over the surface.
[[nodiscard]] bool is_textured(const Material& material);
/// Among what varies over the surface is an image: lookups have footprints.
[[nodiscard]] bool has_images(const Material& material);

/// What this scene and the AOVs asked for call for.
[[nodiscard]] Features required_features(const Scene& scene, const AovSet& aovs);
/// What either has.
[[nodiscard]] Features united(const Features& a, const Features& b);

/// "environment: in the scene" ...; "dispersion: no material's refraction varies with wavelength" ...
struct EffectList {
  std::vector<std::string> used, skipped;
};
/// What the scene calls for is used, by the first material that calls for it where it is materials that do;
/// what is `forced` beside it likewise: "instances: none in the scene (forced)". All others are skipped;
/// where `kernel` still asks whether the scene has one, it says so: "instances: none in the scene (the kernel
/// checks for it all the same)". Thin films and the models of separated materials, which no flag is for, come
/// last.
[[nodiscard]] EffectList list_effects(const Scene& scene, const AovSet& aovs, const Features& forced,
                                      const Features& kernel);

}  // namespace spectrace
