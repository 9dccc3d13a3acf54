// SPDX-License-Identifier: Apache-2.0
// The contract every BSDF keeps. Directions are unit vectors in the shading frame (normal +z); `wo` points to
// the camera, `wi` to the light.
#pragma once

#include <concepts>
#include <cstdint>
#include <optional>

#include "core/image/footprint.h"
#include "core/math/vec.h"
#include "core/spectra/sampled_spectrum.h"
#include "core/spectra/sampled_wavelengths.h"

namespace spectrace {

/// What a BSDF may ask of the point it is evaluated at.
struct ShadingPoint {
  const SampledWavelengths& lambda;
  Vec2 uv{};
  /// What textures are averaged over; a reference, since most materials ask for none.
  const Footprint& footprint = kPointFootprint;
  /// 1 where the texture's v grows towards the frame's +y, -1 where it is mirrored: for normal maps.
  Float v_sign = 1;
};

enum class Lobe : std::uint8_t { kDiffuse, kSpecular };

struct BsdfValue {
  SampledSpectrum value_cos;  ///< f(wo, wi) · |cos θi| [1/sr], >= 0; 0 for delta lobes
  Float pdf = 0;              ///< density per solid angle [1/sr] of sample() returning wi
};

/// value_cos split by lobe. The parts sum to value_cos to float rounding.
struct LobeValues {
  SampledSpectrum diffuse;
  SampledSpectrum fresnel;  ///< the specular lobe, or its Fresnel part where a material tells them apart
  SampledSpectrum diffraction{};  ///< signed (paper, eq. 21); 0 where a material has none
  SampledSpectrum residual{};     ///< signed (ADR 0007); 0 where a material has none

  [[nodiscard]] SampledSpectrum specular() const { return fresnel + diffraction + residual; }
  [[nodiscard]] SampledSpectrum total() const { return diffuse + specular(); }
};

struct BsdfSample {
  Vec3 wi;
  SampledSpectrum weight;  ///< value_cos / pdf; for a delta lobe the limit of that ratio
  Float pdf = 0;           ///< > 0; for a delta lobe the probability of having chosen it
  Lobe lobe = Lobe::kDiffuse;
  bool is_delta = false;
  /// wi depends on wavelength: the caller must terminate the secondary wavelengths; `weight` is the hero's.
  bool is_dispersive = false;
  /// (η_o / η_i)² of a refraction, part of `weight`: radiance is squeezed into a smaller cone and comes back
  /// when the path leaves, so that roulette must not count it as loss (Veach 1997, sec. 5.3.2).
  Float radiance_scale = 1;
  /// Straight on through a hole (a delta lobe, wi = -wo): no vertex of the path. Light is let through there
  /// for shadow rays too (Material's pass_through), so that what competes with light sampling stays as it
  /// was.
  bool passes = false;
};

/// The random numbers of one BSDF sample, each in [0, 1].
struct BsdfRandom {
  Float lobe = 0;
  Vec2 direction;
};

/// What a vertex of a path asks of its material.
struct Scattering {
  BsdfValue towards_light;         ///< 0 where no light was asked for
  std::optional<BsdfSample> next;  ///< where the path goes
};

/// Immutable and shared between threads.
/// - evaluate: value and density together, since they share their table lookups. Both 0 where wi or wo lies
///   in the horizon plane, or, for reflecting lobes, where they lie on different sides.
/// - sample: nullopt where no light leaves or the drawn direction is invalid.
/// - evaluate_lobes: the same value, by lobe.
/// - scatter, where there is one: evaluate() towards *light (nullptr: nothing) and sample(), the same bits,
/// for
///   materials that share work between the two.
/// - is_delta: every lobe is a delta distribution, evaluate() is always 0.
/// - kOnlyLobe, where there is one: all that is reflected is of this lobe.
/// Reflecting materials are one-sided: both directions must have z > 0. The caller flips frames for
/// two-sided shading, except of those that tell their sides apart (Material's keeps_sides).
template <typename T>
concept Bsdf = requires(const T& bsdf, Vec3 wo, Vec3 wi, const ShadingPoint& at, const BsdfRandom& u) {
  { bsdf.evaluate(wo, wi, at) } -> std::same_as<BsdfValue>;
  { bsdf.evaluate_lobes(wo, wi, at) } -> std::same_as<LobeValues>;
  { bsdf.sample(wo, u, at) } -> std::same_as<std::optional<BsdfSample>>;
  { bsdf.is_delta() } -> std::same_as<bool>;
};

}  // namespace spectrace
