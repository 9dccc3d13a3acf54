// SPDX-License-Identifier: Apache-2.0
// How a separated material's specular lobe is importance sampled: half vectors drawn from a table of the lobe
// itself, conditional on the elevation of wo.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/math/vec.h"
#include "core/math/warp2d.h"
#include "core/spectra/sampled_spectrum.h"
#include "materials/half_difference.h"
#include "materials/separated_lookup.h"

namespace spectrace {

/// Immutable. The density is tabulated over (u, v): v = |φ_h - φ_o| / π, and u a logarithm of 1 - cosθ_h, so
/// that a lobe is resolved alike whether it is half a degree or half the hemisphere wide.
class SeparatedSampler {
 public:
  SeparatedSampler(const SeparatedSource& source, SeparationModel model);

  /// Where the elevation of wo falls between those that have tables: found once, for all that follows.
  struct Elevation {
    std::uint32_t lower = 0;
    Float fraction = 0;  ///< in [0, 1], of the way to the next one
  };
  [[nodiscard]] static Elevation elevation(double theta_o_rad);

  /// wi in the upper hemisphere; nullopt where the drawn half vector reflects wo below it. u in [0, 1]².
  [[nodiscard]] std::optional<Vec3> sample(Vec3 wo, Elevation at, Vec2 u) const;
  /// Density per solid angle [1/sr] of sample() returning wi; both above the horizon.
  [[nodiscard]] Float pdf(const PairGeometry& pair, Elevation at) const;
  /// Directional albedo of the specular lobe at wo, by a coarse quadrature: good enough to choose lobes by.
  [[nodiscard]] SampledSpectrum albedo(Elevation at, const SpectralAxis::Lookup& lookup) const;
  /// No light leaves by the specular lobe, at any wavelength.
  [[nodiscard]] bool is_empty() const { return empty_; }

 private:
  [[nodiscard]] static Warp2D::Blend slices(Elevation at);
  [[nodiscard]] Float density(Float u, Float v, Elevation at) const;
  template <typename Tables>
  void tabulate(const Tables& tables, SeparationModel model);

  std::size_t axis_size_ = 0;
  bool empty_ = true;
  Warp2D warp_;                 // [theta_o][u][v]
  std::vector<Float> density_;  // its values: read without its generality, in a third of the time
  std::vector<float> albedo_;   // [theta_o][axis]
};

}  // namespace spectrace
