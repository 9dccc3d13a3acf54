// SPDX-License-Identifier: Apache-2.0
#include "renderer/albedo.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "core/base/error.h"
#include "core/base/overloaded.h"
#include "core/spectra/color.h"

namespace spectrace {

namespace {

constexpr std::size_t kNodes = 65;     // of cosθ: the steepest, at grazing angles, is then within a percent
constexpr std::uint32_t kDraws = 256;  // directions a node, the same for all of them: errors vary smoothly
constexpr Float kGrazing = Float(1e-3);  // cosine of the first node: at 0 no BSDF reflects

/// 32 wavelengths from 390 to 710 nm at equal steps: what D65 and the observer weigh, to 1e-3 of white.
constexpr std::size_t kGroups = 4;
constexpr double kFirst_nm = 395, kStep_nm = 10;

struct WhiteLight {
  std::array<SampledWavelengths, kGroups> lambda;
  std::array<std::array<Rgb, kLanes>, kGroups> weight;  ///< sums to (1, 1, 1): white is white

  WhiteLight() {
    Rgb sum{};
    for (std::size_t g = 0; g < kGroups; ++g) {
      std::array<Float, kLanes> nm{}, pdf{};
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        // Lanes of a group lie apart, as a path's do.
        nm[lane] = static_cast<Float>(kFirst_nm + kStep_nm * double(lane * kGroups + g));
        pdf[lane] = static_cast<Float>(1 / (kStep_nm * kGroups * kLanes));
        const double power = illuminant_d65(double(nm[lane]));
        Xyz xyz = cie_xyz_bar(double(nm[lane]));
        for (double& x : xyz) x *= power;
        weight[g][lane] = xyz_to_rgb(xyz);
        for (std::size_t c = 0; c < 3; ++c) sum[c] += weight[g][lane][c];
      }
      lambda[g] = SampledWavelengths(nm, pdf);
    }
    for (auto& group : weight) {
      for (Rgb& w : group) {
        for (std::size_t c = 0; c < 3; ++c) w[c] /= sum[c];
      }
    }
  }

  void add(const SampledSpectrum& s, std::size_t group, double scale, Rgb& rgb) const {
    for (int lane = 0; lane < kLanes; ++lane) {
      for (std::size_t c = 0; c < 3; ++c) {
        rgb[c] += weight[group][std::size_t(lane)][c] * double(s[lane]) * scale;
      }
    }
  }
};

const WhiteLight& white_light() {
  static const WhiteLight light;
  return light;
}

Rgb in_unit_range(Rgb rgb) {
  for (double& c : rgb) c = std::clamp(c, 0.0, 1.0);
  return rgb;
}

ShadingPoint with_lambda(const ShadingPoint& at, const SampledWavelengths& lambda) {
  return {.lambda = lambda, .uv = at.uv, .footprint = at.footprint, .v_sign = at.v_sign};
}

/// Points of the R4 sequence (Roberts 2018): as even as a lattice, for any number of them.
std::array<Float, 4> draw(std::uint32_t i) {
  constexpr std::array kSteps{0.8566748838545029, 0.7338918566271260, 0.6287067210378087, 0.5385972572236101};
  std::array<Float, 4> u{};
  for (std::size_t d = 0; d < u.size(); ++d) {
    const double x = 0.5 + kSteps[d] * double(i + 1);
    u[d] = static_cast<Float>(x - std::floor(x));
  }
  return u;
}

/// Of a material that tells what its diffuse lobe reflects.
template <typename M>
Rgb told_diffuse(const M& plain, Vec3 wo, const ShadingPoint& point) {
  const Vec3 facing{wo.x, wo.y, std::abs(wo.z)};
  Rgb diffuse{};
  for (std::size_t g = 0; g < kGroups; ++g) {
    const ShadingPoint at = with_lambda(point, white_light().lambda[g]);
    white_light().add(plain.diffuse_albedo(facing, at), g, 1, diffuse);
  }
  return in_unit_range(diffuse);
}

/// The texture of what the diffuse lobe reflects.
const Texture* reflectance_of(const Material& part) {
  return std::visit(
      [](const auto& m) -> const Texture* {
        if constexpr (requires { m.reflectance.palette_size(); }) return &m.reflectance;
        return nullptr;
      },
      part);
}

/// The mean over directions drawn by the BSDF itself.
LobeAlbedo integrate(const Material& part, Vec2 uv, Float cosine) {
  const WhiteLight& light = white_light();
  const std::optional<Lobe> only = only_lobe(part);
  const Float sine = std::sqrt(std::max(Float(0), 1 - cosine * cosine));
  LobeAlbedo albedo;
  for (std::uint32_t i = 0; i < kDraws; ++i) {
    const auto [lobe, u, v, turn] = draw(i);
    const Float phi = 2 * std::numbers::pi_v<Float> * turn;
    const Vec3 wo{sine * std::cos(phi), sine * std::sin(phi), cosine};
    for (std::size_t g = 0; g < kGroups; ++g) {
      const ShadingPoint at{.lambda = light.lambda[g], .uv = uv};
      const auto s = sample(part, wo, {lobe, {u, v}}, at);
      if (!s) continue;
      SampledSpectrum diffuse, specular = s->weight;
      if (only == Lobe::kDiffuse) std::swap(diffuse, specular);
      if (!only && !s->is_delta) {
        const LobeValues lobes = evaluate_lobes(part, wo, s->wi, at);
        diffuse = lobes.diffuse / s->pdf;
        specular = lobes.specular().clamped_at_zero() / s->pdf;
      }
      light.add(diffuse, g, 1.0 / kDraws, albedo.diffuse);
      light.add(specular, g, 1.0 / kDraws, albedo.specular);
    }
  }
  return {in_unit_range(albedo.diffuse), in_unit_range(albedo.specular)};
}

std::vector<LobeAlbedo> tabulate(const Material& part, Vec2 uv, Float side) {
  std::vector<LobeAlbedo> table(kNodes);
  tbb::parallel_for(std::size_t(0), kNodes, [&](std::size_t i) {
    table[i] = integrate(part, uv, side * std::max(kGrazing, Float(i) / Float(kNodes - 1)));
  });
  return table;
}

void add_scaled(const LobeAlbedo& a, double scale, LobeAlbedo& sum) {
  for (std::size_t c = 0; c < 3; ++c) {
    sum.diffuse[c] += a.diffuse[c] * scale;
    sum.specular[c] += a.specular[c] * scale;
  }
}

}  // namespace

AlbedoTables::AlbedoTables(const std::vector<Material>& materials) {
  for (const Material& material : materials) {
    for_each_part(material, [&](const Material& part) { add(part); });
  }
}

void AlbedoTables::add(const Material& part) {
  const bool is_plain = std::visit(
      [](const auto& m) {
        return !requires { m.parts(); };
      },
      part);
  if (!is_plain || tables_.contains(&part)) return;
  const Texture* texture = reflectance_of(part);
  std::vector<Sides> by_palette(texture != nullptr ? std::max<std::size_t>(texture->palette_size(), 1) : 1);
  for (std::size_t i = 0; i < by_palette.size(); ++i) {
    const Vec2 uv = texture != nullptr ? texture->palette_uv(i) : Vec2{};
    by_palette[i].front = tabulate(part, uv, 1);
    if (keeps_sides(part)) by_palette[i].back = tabulate(part, uv, -1);
  }
  tables_.emplace(&part, std::move(by_palette));
}

LobeAlbedo AlbedoTables::look_up(const Material& part, std::size_t palette_index, Vec3 wo) const {
  const auto it = tables_.find(&part);
  SPECTRACE_CHECK(it != tables_.end());
  const Sides& sides = it->second[palette_index];
  const Table& table = wo.z < 0 && !sides.back.empty() ? sides.back : sides.front;
  const double position = std::min(1.0, std::abs(double(wo.z))) * double(kNodes - 1);
  const auto i = std::min(std::size_t(position), kNodes - 2);
  const double t = position - double(i);
  LobeAlbedo albedo;
  add_scaled(table[i], 1 - t, albedo);
  add_scaled(table[i + 1], t, albedo);
  return albedo;
}

LobeAlbedo AlbedoTables::at(const Material& material, Vec3 wo, const ShadingPoint& point) const {
  const auto of = [&](const NestedMaterial* part) { return at(part->node().material, wo, point); };
  return std::visit(Overloaded{[&](const Mix& mix) {
                                 const double weight = double(mix.weight(point));
                                 LobeAlbedo sum;
                                 add_scaled(of(mix.parts()[0]), 1 - weight, sum);
                                 add_scaled(of(mix.parts()[1]), weight, sum);
                                 return sum;
                               },
                               [&](const TwoSided& sides) { return of(sides.parts()[wo.z < 0 ? 1 : 0]); },
                               // The share of a mask that is no hole is what was hit; bumps hardly change how
                               // much is reflected.
                               [&](const Masked& masked) { return of(masked.parts()[0]); },
                               [&](const NormalMapped& mapped) { return of(mapped.parts()[0]); },
                               [&](const auto& plain) {
                                 if constexpr (requires { plain.reflectance.palette_size(); }) {
                                   const Texture& texture = plain.reflectance;
                                   LobeAlbedo albedo = look_up(material, texture.palette_index(point.uv), wo);
                                   if (texture.is_image()) albedo.diffuse = told_diffuse(plain, wo, point);
                                   return albedo;
                                 } else {
                                   return look_up(material, 0, wo);
                                 }
                               }},
                    material);
}

}  // namespace spectrace
