// SPDX-License-Identifier: Apache-2.0
#include "renderer/obj_materials.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/spectra/rgb_uplift.h"

namespace spectrace {

namespace {

using Kind = decltype(MaterialDesc::kind);

// The coat that the PBR extension means by a surface that is no metal.
constexpr Float kCoatEta = Float(1.5);

Float largest(const Rgb& rgb) { return static_cast<Float>(std::max({rgb[0], rgb[1], rgb[2]})); }

Rgb scaled(const Rgb& rgb, double factor) { return {rgb[0] * factor, rgb[1] * factor, rgb[2] * factor}; }

/// map_Kd takes the place of Kd: nearly every exporter writes both and means
/// the image.
Texture diffuse_texture(const MtlMaterial& mtl) {
  if (!mtl.diffuse_map.empty()) return image_texture(mtl.diffuse_map);
  return Spectrum(uplift_reflectance(mtl.diffuse.value_or(Rgb{})));
}

Ggx isotropic(double alpha) {
  const Float a = std::clamp(static_cast<Float>(alpha), kMinAlpha, Float(1));
  return {a, a};
}

/// Kd and Ks are reflectances at normal incidence: f = Kd / π + GGX with f0 =
/// Ks. A material's lobes share the surface, shares s and 1 - s of it: with s =
/// Ks / (Kd + Ks) each lobe's own reflectance is Kd + Ks. Where that is more
/// than 1 both are scaled down.
Kind phong(const MtlMaterial& mtl) {
  const Rgb ks = *mtl.specular;
  const Rgb kd = mtl.diffuse_map.empty() ? mtl.diffuse.value_or(Rgb{}) : Rgb{1, 1, 1};
  const double specular = largest(ks), sum = specular + largest(kd), level = std::min(sum, 1.0);
  Kind kind;
  auto& glossy = kind.emplace<Glossy>();
  glossy.specular_scale = static_cast<Float>(specular / sum);
  glossy.diffuse_scale = 1 - glossy.specular_scale;
  glossy.fresnel = SchlickFresnel{Spectrum(uplift_reflectance(scaled(ks, level / specular)))};
  glossy.reflectance = mtl.diffuse_map.empty() && largest(kd) > 0
                           ? Texture(Spectrum(uplift_reflectance(scaled(kd, level / largest(kd)))))
                           : diffuse_texture(mtl);
  // Blinn-Phong's exponent as a slope: Walter et al. 2007, sec. 5.2, alpha_p = 2 / alpha² - 2.
  glossy.ggx = isotropic(std::sqrt(2 / (mtl.exponent.value_or(0) + 2)));
  return kind;
}

/// Pr and Pm: plastic, metal with Kd as its colour at normal incidence, or a
/// mix of both. Roughness is squared, as everywhere since Burley 2012.
Kind metallic_roughness(const MtlMaterial& mtl) {
  const Ggx ggx = isotropic(mtl.roughness.value_or(0.5) * mtl.roughness.value_or(0.5));
  const double metallic = mtl.metallic.value_or(0);
  const PlasticDesc plastic{diffuse_texture(mtl), Spectrum::constant(kCoatEta), ggx.alpha_x};
  if (metallic == 0) return plastic;
  Kind kind;
  auto& metal = kind.emplace<Glossy>();
  metal.fresnel = SchlickFresnel{Spectrum(uplift_reflectance(mtl.diffuse.value_or(Rgb{1, 1, 1})))};
  metal.ggx = ggx;
  metal.specular_scale = 1;
  metal.diffuse_scale = 0;
  if (metallic == 1) return kind;
  MixDesc mix;
  mix.parts.push_back({.name = "", .where = "", .kind = plastic});
  mix.parts.push_back({.name = "", .where = "", .kind = std::move(kind)});
  mix.weight = static_cast<Float>(metallic);
  return mix;
}

Kind surface(const MtlMaterial& mtl) {
  const bool refracts = mtl.illumination == 6 || mtl.illumination == 7;
  if (refracts && mtl.refractive_index) {
    return Dielectric{Spectrum::constant(static_cast<Float>(*mtl.refractive_index))};
  }
  if (mtl.roughness || mtl.metallic) return metallic_roughness(mtl);
  if (mtl.specular && largest(*mtl.specular) > 0 && mtl.illumination >= 2) return phong(mtl);
  return Lambert{diffuse_texture(mtl)};
}

}  // namespace

MaterialDesc to_material(const MtlMaterial& mtl) {
  MaterialDesc material{.name = mtl.name, .where = "", .kind = surface(mtl)};
  const auto wrap = [&](auto outer) {
    outer.parts.push_back({.name = "", .where = "", .kind = std::move(material.kind)});
    material.kind = std::move(outer);
  };
  if (!mtl.normal_map.empty()) {
    wrap(NormalMappedDesc{.parts = {}, .normals = normal_bitmap(mtl.normal_map)});
  }
  if (!mtl.opacity_map.empty()) {
    wrap(MaskedDesc{.parts = {}, .opacity = scalar_bitmap(mtl.opacity_map)});
  } else if (mtl.opacity && *mtl.opacity < 1 && !std::holds_alternative<Dielectric>(material.kind)) {
    wrap(MaskedDesc{.parts = {}, .opacity = static_cast<Float>(*mtl.opacity)});
  }
  return material;
}

std::vector<std::string> without_effect(const MtlMaterial& mtl) {
  std::vector<std::string> statements = mtl.without_effect;
  if (mtl.metallic.value_or(0) > 0 && !mtl.diffuse_map.empty())
    statements.emplace_back("map_Kd (of the metal)");
  if (mtl.illumination == 3 || mtl.illumination == 5) statements.emplace_back("illum of a mirror");
  return statements;
}

std::optional<Spectrum> to_emission(const MtlMaterial& mtl) {
  if (!mtl.emission || !(largest(*mtl.emission) > 0)) return std::nullopt;
  return Spectrum(uplift_emission(*mtl.emission));
}

}  // namespace spectrace
