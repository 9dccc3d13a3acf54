// SPDX-License-Identifier: Apache-2.0
#include "renderer/approximations.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <utility>

#include "core/base/error.h"

namespace spectrace {

namespace {

/// Fraunhofer's d line, of helium, at which indices of glass are given.
constexpr Float kLineDNm = Float(587.56);

/// Lets `change` at the kinds of all materials and their parts; true where it has changed one.
template <typename Change>
bool change_materials(SceneDesc& scene, const Change& change) {
  bool any = false;
  for (MaterialDesc& material : scene.materials) {
    for_each_desc(material, [&](MaterialDesc& part) {
      std::visit([&](auto& kind) { any = change(kind) || any; }, part.kind);
    });
  }
  return any;
}

/// Keeps the lights that `stays` says yes to; true where one went.
template <typename Stays>
bool keep_lights(SceneDesc& scene, const Stays& stays) {
  return std::erase_if(scene.lights, [&](const LightDesc& light) { return !stays(light); }) > 0;
}

bool no_indirect_light(SceneDesc& scene) { return std::exchange(scene.integrator.max_depth, 1) > 1; }

bool no_depth_of_field(SceneDesc& scene) { return std::exchange(scene.camera.lens_radius, Float(0)) > 0; }

bool no_environment(SceneDesc& scene) {
  return keep_lights(scene,
                     [](const LightDesc& light) { return !std::holds_alternative<EnvironmentDesc>(light); });
}

bool no_delta_lights(SceneDesc& scene) {
  return keep_lights(scene,
                     [](const LightDesc& light) { return std::holds_alternative<EnvironmentDesc>(light); });
}

bool no_area_lights(SceneDesc& scene) {
  bool any = false;
  for (ShapeDesc& shape : scene.shapes) any = std::exchange(shape.emission, {}).has_value() || any;
  return any;
}

bool no_dispersion(SceneDesc& scene) {
  const auto index = [](const Spectrum& eta) { return Spectrum::constant(eta.at(kLineDNm)); };
  return change_materials(scene, [&]<typename Kind>(Kind& kind) {
    if constexpr (std::is_same_v<Kind, Dielectric>) {
      if (kind.eta.is_constant()) return false;
      kind.eta = index(kind.eta);
      return true;
    } else if constexpr (std::is_same_v<Kind, RoughDielectric>) {
      if (kind.eta().is_constant()) return false;
      kind = RoughDielectric(index(kind.eta()), kind.ggx(), kind.film());
      return true;
    }
    return false;
  });
}

bool no_thin_film(SceneDesc& scene) {
  return change_materials(scene, []<typename Kind>(Kind& kind) {
    if constexpr (std::is_same_v<Kind, RoughDielectric>) {
      if (!kind.film()) return false;
      kind = RoughDielectric(kind.eta(), kind.ggx());
      return true;
    } else if constexpr (requires { kind.fresnel.film; }) {
      return std::exchange(kind.fresnel.film, {}).has_value();
    } else if constexpr (requires { kind.film; }) {
      return std::exchange(kind.film, {}).has_value();
    }
    return false;
  });
}

/// One value for all of the surface, in place of its texture; true where there was one.
template <typename T>
bool flatten(T& texture, T mean) {
  if (!texture.is_textured()) return false;
  texture = std::move(mean);
  return true;
}

bool no_textures(SceneDesc& scene) {
  return change_materials(scene, []<typename Kind>(Kind& kind) {
    if constexpr (requires { kind.reflectance.mean(); }) {
      return flatten(kind.reflectance, Texture(kind.reflectance.mean()));
    } else if constexpr (requires { kind.weight.mean(); }) {
      return flatten(kind.weight, ScalarTexture(kind.weight.mean()));
    } else if constexpr (requires { kind.opacity.mean(); }) {
      return flatten(kind.opacity, ScalarTexture(kind.opacity.mean()));
    } else if constexpr (requires { kind.normals; }) {
      return flatten(kind.normals, NormalTexture());
    }
    return false;
  });
}

/// Separated materials are rendered with `poorer` where they would be with a richer model.
bool at_most(SceneDesc& scene, SeparationModel poorer) {
  return change_materials(scene, [&]<typename Kind>(Kind& kind) {
    if constexpr (std::is_same_v<Kind, SeparatedDesc>) {
      if (kind.analytic || (kind.model && *kind.model <= poorer)) return false;
      kind.model = poorer;
      return true;
    }
    return false;
  });
}
bool no_residual(SceneDesc& scene) { return at_most(scene, SeparationModel::kDiffraction); }
bool no_diffraction(SceneDesc& scene) { return at_most(scene, SeparationModel::kFresnel); }

constexpr std::array kApproximations{
    Approximation{"indirect-light", "light that reaches what is seen from lights alone (max_depth 1)",
                  no_indirect_light},
    Approximation{"environment", "darkness all around", no_environment},
    Approximation{"area-lights", "shapes that do not emit", no_area_lights},
    Approximation{"delta-lights", "no point, spot and directional lights", no_delta_lights},
    Approximation{"depth-of-field", "a pinhole", no_depth_of_field},
    Approximation{"dispersion", "indices of refraction of 587.56 nm at all wavelengths", no_dispersion},
    Approximation{"thin-film", "bare interfaces", no_thin_film},
    Approximation{"textures",
                  "reflectances, weights and opacities averaged over their textures, flat normals",
                  no_textures},
    Approximation{"residual", "separated materials by the diffraction model", no_residual},
    Approximation{"diffraction", "separated materials by the Fresnel model", no_diffraction},
};

}  // namespace

std::span<const Approximation> approximations() { return kApproximations; }

bool approximate(SceneDesc& scene, std::string_view effect) {
  const auto it = std::find_if(kApproximations.begin(), kApproximations.end(),
                               [&](const Approximation& a) { return a.effect == effect; });
  SPECTRACE_CHECK(it != kApproximations.end());
  if (!it->remove(scene)) return false;
  scene.approximations.push_back(fmt::format("without {}: {}", it->effect, it->instead));
  return true;
}

}  // namespace spectrace
