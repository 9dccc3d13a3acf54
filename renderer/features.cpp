// SPDX-License-Identifier: Apache-2.0
#include "renderer/features.h"

#include <fmt/core.h>

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

bool has_specular_parts(const Material& material) {
  if (const auto* paired = std::get_if<PairedBrdf>(&material)) return paired->has_specular_parts();
  const auto* separated = std::get_if<SeparatedBrdf>(&material);
  return separated != nullptr && separated->has_specular_parts();
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

/// ", by the material \"glass\"", or nothing where it is no material that calls for it.
std::string whose(const Scene& scene, const AovSet& aovs, bool Features::*flag) {
  for (const Shape& shape : scene.geometry.shapes) {
    if (features_of(scene.materials[shape.material], aovs).*flag) {
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
      list.used.push_back(fmt::format("{}: {}{}", info.name, info.present, whose(scene, aovs, info.flag)));
    } else if (forced.*info.flag) {
      list.used.push_back(fmt::format("{}: {} (forced)", info.name, info.missing));
    } else {
      list.skipped.push_back(
          fmt::format("{}: {}{}", info.name, info.missing,
                      kernel.*info.flag ? " (the kernel checks for it all the same)" : ""));
    }
  }
  return list;
}

}  // namespace spectrace
