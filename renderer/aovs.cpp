// SPDX-License-Identifier: Apache-2.0
#include "renderer/aovs.h"

#include <fmt/format.h>

#include <array>
#include <vector>

#include "core/base/nearest.h"

namespace spectrace {

namespace {

constexpr AovSet kLobesOnly{.lobes = true};
constexpr AovSet with(bool AovSet::*flag, bool AovSet::*second = nullptr) {
  AovSet set;
  set.*flag = true;
  if (second != nullptr) set.*second = true;
  return set;
}
constexpr AovSet kDirect = with(&AovSet::lobes, &AovSet::direct);
constexpr AovSet kParts = with(&AovSet::lobes, &AovSet::specular_parts);

constexpr std::array kNames{
    AovName{"none", kNoAovs},
    AovName{"lobes", kLobeAovs},
    AovName{"denoise", kDenoiseAovs},
    AovName{"all", kAllAovs},
    AovName{"xyz", with(&AovSet::xyz)},
    AovName{"diffuse", kLobesOnly},
    AovName{"specular", kLobesOnly},
    AovName{"emission", kLobesOnly},
    AovName{"background", kLobesOnly},
    AovName{"specular_fresnel", kParts},
    AovName{"specular_diffraction", kParts},
    AovName{"specular_residual", kParts},
    AovName{"diffuse_direct", kDirect},
    AovName{"diffuse_indirect", kDirect},
    AovName{"specular_direct", kDirect},
    AovName{"specular_indirect", kDirect},
    AovName{"halves", with(&AovSet::halves)},
    AovName{"variance", with(&AovSet::variance)},
    AovName{"diffuse_albedo", with(&AovSet::albedo)},
    AovName{"specular_albedo", with(&AovSet::albedo)},
    AovName{"albedo", with(&AovSet::albedo)},
    AovName{"normal", with(&AovSet::normal)},
    AovName{"position", with(&AovSet::position)},
    AovName{"depth", with(&AovSet::depth)},
    AovName{"feature_variance", with(&AovSet::feature_variance)},
    AovName{"samples", with(&AovSet::samples)},
    AovName{"extrapolated", with(&AovSet::extrapolated)},
    AovName{"crypto_object", with(&AovSet::crypto_object)},
    AovName{"crypto_material", with(&AovSet::crypto_material)},
};

/// What to ask for to get statistics of a layer: "halves" of "diffuse_a"; nothing for other names.
std::string_view group_of_channel(std::string_view name) {
  const auto is = [&](std::string_view layer, std::string_view suffix) {
    return name.size() == layer.size() + suffix.size() && name.starts_with(layer) && name.ends_with(suffix);
  };
  for (const std::string_view layer : {"beauty", "diffuse", "specular"}) {
    if (is(layer, "_a") || is(layer, "_b")) return "halves";
    if (is(layer, "_variance")) return "variance";
  }
  for (const Feature feature : kFeatureList) {
    if (is(feature_name(feature), "_variance")) return "feature_variance";
  }
  return {};
}

}  // namespace

AovSet operator|(AovSet a, const AovSet& b) {
  for (bool AovSet::*flag : kAovFlags) a.*flag = a.*flag || b.*flag;
  return a;
}

std::span<const AovName> aov_names() { return kNames; }

std::optional<std::string> add_aov(std::string_view name, AovSet& set) {
  std::vector<std::string> known;
  for (const AovName& each : kNames) {
    if (each.name == name) {
      set = set | each.set;
      return std::nullopt;
    }
    known.emplace_back(each.name);
  }
  const std::string_view group = group_of_channel(name);
  return fmt::format("there is no AOV \"{}\"{}", name,
                     group.empty() ? suggestion(name, known) : fmt::format("; \"{}\" has it", group));
}

std::string_view feature_name(Feature feature) {
  switch (feature) {
    case Feature::kDiffuseAlbedo:
      return "diffuse_albedo";
    case Feature::kSpecularAlbedo:
      return "specular_albedo";
    case Feature::kAlbedo:
      return "albedo";
    case Feature::kNormal:
      return "normal";
    case Feature::kPosition:
      return "position";
    case Feature::kDepth:
      return "depth";
  }
  return {};
}

}  // namespace spectrace
