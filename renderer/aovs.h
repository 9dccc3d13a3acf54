// SPDX-License-Identifier: Apache-2.0
// What an image holds beside its beauty: arbitrary output variables (AOVs), by the names docs/aovs.md gives
// them.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/layers.h"
#include "renderer/pixel_sums.h"

namespace spectrace {

/// What is gathered; only what is asked for is paid for.
struct AovSet {
  bool xyz = false;             ///< X, Y, Z of the beauty
  bool lobes = false;           ///< diffuse, specular, emission, background
  bool specular_parts = false;  ///< specular_fresnel, _diffraction, _residual, where a material has them
  bool direct = false;          ///< diffuse and specular, each direct and indirect
  bool halves = false;  ///< of beauty, diffuse, specular: two halves of the samples apart (samples_in_half_b)
  bool variance = false;  ///< of the mean, of the same
  bool albedo = false;    ///< diffuse_albedo, specular_albedo, albedo: free of noise by wavelength
  bool normal = false, position = false, depth = false;
  bool feature_variance = false;                        ///< of those of the features above that are asked for
  bool samples = false;                                 ///< how many were taken
  bool extrapolated = false;                            ///< vertices seen from beyond what was measured
  bool crypto_object = false, crypto_material = false;  ///< coverage by what is seen (renderer/matte.h)

  friend constexpr bool operator==(const AovSet&, const AovSet&) = default;

  [[nodiscard]] constexpr bool any_matte() const { return crypto_object || crypto_material; }
  [[nodiscard]] constexpr bool any_feature() const { return albedo || normal || position || depth; }
  [[nodiscard]] constexpr bool has(Feature feature) const {
    switch (feature) {
      case Feature::kNormal:
        return normal;
      case Feature::kPosition:
        return position;
      case Feature::kDepth:
        return depth;
      default:
        return albedo;
    }
  }
};

inline constexpr std::array kAovFlags{
    &AovSet::lobes,         &AovSet::specular_parts,   &AovSet::direct,  &AovSet::halves,
    &AovSet::variance,      &AovSet::albedo,           &AovSet::normal,  &AovSet::position,
    &AovSet::depth,         &AovSet::feature_variance, &AovSet::samples, &AovSet::extrapolated,
    &AovSet::crypto_object, &AovSet::crypto_material,  &AovSet::xyz};
[[nodiscard]] AovSet operator|(AovSet a, const AovSet& b);

inline constexpr AovSet kNoAovs{};
/// What an image has where nothing else is asked for.
inline constexpr AovSet kLobeAovs{.lobes = true, .specular_parts = true};
/// All that denoisers want ("denoise").
inline constexpr AovSet kAllAovs = [] {
  AovSet set;
  for (bool AovSet::*flag : kAovFlags) set.*flag = true;
  return set;
}();
/// All that denoisers want.
inline constexpr AovSet kDenoiseAovs = [] {
  AovSet set = kAllAovs;
  set.xyz = set.specular_parts = set.extrapolated = set.crypto_object = set.crypto_material = false;
  return set;
}();

/// One name that may be asked for: a group ("denoise") or what the channels of one begin with.
struct AovName {
  std::string_view name;
  AovSet set;
};
[[nodiscard]] std::span<const AovName> aov_names();
/// Adds what a name stands for; what is wrong with it, where there is none such.
[[nodiscard]] std::optional<std::string> add_aov(std::string_view name, AovSet& set);

/// "diffuse_albedo", ...
[[nodiscard]] std::string_view feature_name(Feature feature);

}  // namespace spectrace
