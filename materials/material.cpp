// SPDX-License-Identifier: Apache-2.0
#include "materials/material.h"

namespace spectrace {

BsdfValue evaluate(const Material& material, Vec3 wo, Vec3 wi, const ShadingPoint& at) {
  return std::visit([&](const auto& m) { return m.evaluate(wo, wi, at); }, material);
}

LobeValues evaluate_lobes(const Material& material, Vec3 wo, Vec3 wi, const ShadingPoint& at) {
  return std::visit([&](const auto& m) { return m.evaluate_lobes(wo, wi, at); }, material);
}

std::optional<BsdfSample> sample(const Material& material, Vec3 wo, const BsdfRandom& u,
                                 const ShadingPoint& at) {
  return std::visit([&](const auto& m) { return m.sample(wo, u, at); }, material);
}

bool is_delta(const Material& material) {
  return std::visit([](const auto& m) { return m.is_delta(); }, material);
}

bool has_delta_lobe(const Material& material) {
  const auto* plastic = std::get_if<Plastic>(&material);
  return plastic != nullptr ? plastic->has_delta_lobe() : is_delta(material);
}

bool is_transmissive(const Material& material) {
  return std::holds_alternative<Dielectric>(material) || std::holds_alternative<RoughDielectric>(material);
}

bool keeps_sides(const Material& material) { return is_transmissive(material); }

}  // namespace spectrace
