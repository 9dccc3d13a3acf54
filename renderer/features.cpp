// SPDX-License-Identifier: Apache-2.0
#include "renderer/features.h"

#include <fmt/core.h>

#include <array>
#include <string_view>
#include <type_traits>
#include <variant>

namespace spectrace {

namespace {

/// Does `holds` of a texture of the material, or of a part of it?
template <typename Holds>
bool any_texture(const Material& material, const Holds& holds) {
  bool any = false;
  for_each_part(material, [&](const Material& part) {
    std::visit(
        [&]<typename M>(const M& m) {
          if constexpr (requires { m.reflectance.is_textured(); }) {
            any = any || holds(m.reflectance);
          } else if constexpr (requires { m.texture(); }) {
            any = any || holds(m.texture());
          }
        },
        part);
  });
  return any;
}

bool is_dispersive(const Material& material) {
  const auto* glass = std::get_if<Dielectric>(&material);
  return glass != nullptr && !glass->eta.is_constant();
}

const SeparatedBrdf* separated_values(const Material& material) {
  if (const auto* paired = std::get_if<PairedBrdf>(&material)) return paired->separated();
  return std::get_if<SeparatedBrdf>(&material);
}
bool is_at_least(const Material& material, SeparationModel model) {
  const SeparatedBrdf* separated = separated_values(material);
  return separated != nullptr && separated->model() >= model;
}

bool has_specular_parts(const Material& material) {
  const SeparatedBrdf* separated = separated_values(material);
  return separated != nullptr && separated->has_specular_parts();
}

bool has_thin_film(const Material& material) {
  return std::visit(
      []<typename M>(const M& m) {
        if constexpr (std::is_same_v<M, RoughDielectric>) {
          return m.film().has_value();
        } else if constexpr (requires { m.fresnel.film; }) {
          return m.fresnel.film.has_value();
        } else if constexpr (requires { m.film; }) {
          return m.film.has_value();
        } else {
          return false;
        }
      },
      material);
}

/// No kernel tells whether a material has it: it is part of the material.
struct MaterialEffect {
  std::string_view name;
  std::string_view present, missing;
  bool (*of)(const Material& part);
};
constexpr std::array<MaterialEffect, 3> kMaterialEffects{
    {{"thin film", "an interface has one", "no interface has one", has_thin_film},
     {"diffraction effect", "a separated material is rendered by a model that has it",
      "no separated material is rendered by a model that has it",
      [](const Material& part) { return is_at_least(part, SeparationModel::kDiffraction); }},
     {"residual", "a separated material is rendered by the model that has it",
      "no separated material is rendered by the model that has it",
      [](const Material& part) { return is_at_least(part, SeparationModel::kResidual); }}}};

bool has_part(const Material& material, const MaterialEffect& effect) {
  bool any = false;
  for_each_part(material, [&](const Material& part) { any = any || effect.of(part); });
  return any;
}

/// What a material that is seen calls for.
Features features_of(const Material& material, const AovSet& aovs) {
  Features f{.delta_lobes = is_delta(material),
             .transmission = is_transmissive(material),
             .textures = is_textured(material)};
  for_each_part(material, [&](const Material& part) {
    f.dispersion |= is_dispersive(part);
    f.nested |= &part != &material;
    f.specular_parts |= aovs.lobes && aovs.specular_parts && has_specular_parts(part);
  });
  return f;
}

/// ", by the material \"glass\"", or nothing where no material that is seen calls for it.
template <typename CallsForIt>
std::string whose(const Scene& scene, const CallsForIt& calls_for_it) {
  for (const Shape& shape : scene.geometry.shapes) {
    if (calls_for_it(scene.materials[shape.material])) {
      return fmt::format(", by the material \"{}\"", scene.material_names[shape.material]);
    }
  }
  return "";
}

}  // namespace

bool is_textured(const Material& material) {
  return any_texture(material, [](const auto& texture) { return texture.is_textured(); });
}

bool has_images(const Material& material) {
  return any_texture(material, [](const auto& texture) { return texture.is_image(); });
}

Features required_features(const Scene& scene, const AovSet& aovs) {
  Features f{.depth_of_field = scene.camera.has_lens(),
             .indirect = scene.integrator.max_depth > 1,
             .area_lights = scene.lights.area_count() > 0,
             .delta_lights = scene.lights.delta_count() > 0,
             .environment = scene.lights.environment().has_value(),
             .instances = !scene.geometry.instances.empty(),
             .lobe_layers = aovs.lobes,
             .more_aovs = aovs.direct || aovs.halves || aovs.variance || aovs.any_feature() ||
                          aovs.any_matte() || aovs.extrapolated,
             .spectral_film = scene.film.spectral.has_value()};
  for (const Shape& shape : scene.geometry.shapes) {
    f = united(f, features_of(scene.materials[shape.material], aovs));
  }
  return f;
}

Features united(const Features& a, const Features& b) {
  Features f = a;
  for (const FeatureInfo& info : kFeatureInfos) f.*info.flag |= b.*info.flag;
  return f;
}

EffectList list_effects(const Scene& scene, const AovSet& aovs, const Features& forced,
                        const Features& kernel) {
  const Features needed = required_features(scene, aovs);
  EffectList list;
  for (const FeatureInfo& info : kFeatureInfos) {
    if (needed.*info.flag) {
      const std::string by = whose(scene, [&](const Material& m) { return features_of(m, aovs).*info.flag; });
      list.used.push_back(fmt::format("{}: {}{}", info.name, info.present, by));
    } else if (forced.*info.flag) {
      list.used.push_back(fmt::format("{}: {} (forced)", info.name, info.missing));
    } else {
      list.skipped.push_back(
          fmt::format("{}: {}{}", info.name, info.missing,
                      kernel.*info.flag ? " (the kernel checks for it all the same)" : ""));
    }
  }
  for (const MaterialEffect& effect : kMaterialEffects) {
    const std::string by = whose(scene, [&](const Material& m) { return has_part(m, effect); });
    if (by.empty()) {
      list.skipped.push_back(fmt::format("{}: {}", effect.name, effect.missing));
    } else {
      list.used.push_back(fmt::format("{}: {}{}", effect.name, effect.present, by));
    }
  }
  return list;
}

}  // namespace spectrace
