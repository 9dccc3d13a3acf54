// SPDX-License-Identifier: Apache-2.0
#include "materials/material.h"

#include <cmath>
#include <memory>
#include <type_traits>
#include <utility>

namespace spectrace {

namespace {

/// Nearer to the horizon plane, squares of z underflow: the sum of two directions there has no length. NaN
/// lies in it too.
constexpr Float kLeastCosine = 1e-18F;

bool is_in_horizon(Vec3 w) { return !(std::abs(w.z) >= kLeastCosine); }

}  // namespace

BsdfValue evaluate(const Material& material, Vec3 wo, Vec3 wi, const ShadingPoint& at) {
  if (is_in_horizon(wo) || is_in_horizon(wi)) return {};
  return std::visit([&](const auto& m) { return m.evaluate(wo, wi, at); }, material);
}

LobeValues evaluate_lobes(const Material& material, Vec3 wo, Vec3 wi, const ShadingPoint& at) {
  if (is_in_horizon(wo) || is_in_horizon(wi)) return {};
  return std::visit([&](const auto& m) { return m.evaluate_lobes(wo, wi, at); }, material);
}

std::optional<BsdfSample> sample(const Material& material, Vec3 wo, const BsdfRandom& u,
                                 const ShadingPoint& at) {
  if (is_in_horizon(wo)) return std::nullopt;
  std::optional<BsdfSample> drawn = std::visit([&](const auto& m) { return m.sample(wo, u, at); }, material);
  if (drawn && is_in_horizon(drawn->wi)) return std::nullopt;
  return drawn;
}

Scattering scatter(const Material& material, Vec3 wo, const std::optional<Vec3>& light, const BsdfRandom& u,
                   const ShadingPoint& at) {
  if (is_in_horizon(wo)) return {};
  const Vec3* const towards = light && !is_in_horizon(*light) ? &*light : nullptr;
  Scattering result = std::visit(
      [&](const auto& m) -> Scattering {
        if constexpr (requires { m.scatter(wo, towards, u, at); }) {
          return m.scatter(wo, towards, u, at);
        } else {
          return {towards != nullptr ? m.evaluate(wo, *towards, at) : BsdfValue{}, m.sample(wo, u, at)};
        }
      },
      material);
  if (result.next && is_in_horizon(result.next->wi)) result.next.reset();
  return result;
}

bool is_delta(const Material& material) {
  return std::visit([](const auto& m) { return m.is_delta(); }, material);
}

std::optional<Lobe> only_lobe(const Material& material) {
  return std::visit(
      []<typename M>(const M&) -> std::optional<Lobe> {
        if constexpr (requires { M::kOnlyLobe; }) return M::kOnlyLobe;
        return std::nullopt;
      },
      material);
}

NestedMaterial nest(Material material) {
  return NestedMaterial(std::make_shared<const MaterialNode>(MaterialNode{std::move(material)}));
}

void for_each_part(const Material& material, const std::function<void(const Material&)>& visit) {
  visit(material);
  std::visit(
      [&](const auto& m) {
        if constexpr (requires { m.parts(); }) {
          for (const NestedMaterial* part : m.parts()) for_each_part(part->node().material, visit);
        }
      },
      material);
}

namespace {

template <typename Predicate>
bool any_part(const Material& material, const Predicate& predicate) {
  bool any = false;
  for_each_part(material, [&](const Material& part) { any = any || predicate(part); });
  return any;
}

template <typename Kind>
bool is_made_with(const Material& material) {
  return any_part(material, [](const Material& part) { return std::holds_alternative<Kind>(part); });
}

}  // namespace

bool has_delta_lobe(const Material& material) {
  return any_part(material, [](const Material& part) {
    const auto* plastic = std::get_if<Plastic>(&part);
    return (plastic != nullptr && plastic->has_delta_lobe()) || std::holds_alternative<Masked>(part) ||
           is_delta(part);
  });
}

bool is_transmissive(const Material& material) {
  return is_made_with<Dielectric>(material) || is_made_with<RoughDielectric>(material);
}

bool keeps_sides(const Material& material) {
  return std::visit(
      []<typename M>(const M& m) {
        return requires { m.parts(); }
        || std::is_same_v<M, Dielectric> || std::is_same_v<M, RoughDielectric>;
      },
      material);
}

Float pass_through(const Material& material, bool from_front, const ShadingPoint& at) {
  return std::visit(
      [&](const auto& m) -> Float {
        if constexpr (requires { m.pass_through(from_front, at); }) return m.pass_through(from_front, at);
        return 0;
      },
      material);
}

bool has_holes(const Material& material) { return is_made_with<Masked>(material); }

}  // namespace spectrace
