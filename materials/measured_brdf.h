// SPDX-License-Identifier: Apache-2.0
// The measured BRDF as a BSDF: evaluated, sampled, integrated from its tables.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>

#include "core/math/warp2d.h"
#include "materials/bsdf.h"
#include "materials/measured_tables.h"

namespace spectrace {

/// Cheap to copy: the tables are shared.
class MeasuredBrdf {
 public:
  static constexpr Lobe kOnlyLobe = Lobe::kSpecular;
  explicit MeasuredBrdf(const MeasuredTables& tables);

  [[nodiscard]] BsdfValue evaluate(Vec3 wo, Vec3 wi, const ShadingPoint& at) const;
  /// A measurement does not tell its lobes apart: all of it is `fresnel`, that is, specular.
  [[nodiscard]] LobeValues evaluate_lobes(Vec3 wo, Vec3 wi, const ShadingPoint& at) const;
  [[nodiscard]] std::optional<BsdfSample> sample(Vec3 wo, const BsdfRandom& u, const ShadingPoint& at) const;
  [[nodiscard]] bool is_delta() const { return false; }

  /// Where a direction pair falls in the tables: found once, applied to all wavelengths.
  struct Footprint {
    static constexpr int kMaxNodes = 16;
    std::array<std::uint32_t, kMaxNodes> row{};  ///< index of a spectrum, contiguous over the axis
    std::array<float, kMaxNodes> weight{};  ///< includes ndf / (4 sigma): Σ weight · spectrum = f·cosθi
    int count = 0;
    bool extrapolated = false;  ///< wo lies beyond the last measured elevation
    bool measured = false;      ///< at least half the weight lies on cells marked valid and not extrapolated
  };
  /// nullopt below the horizon of either direction, and for wi = -wo.
  [[nodiscard]] std::optional<Footprint> footprint(Vec3 wo, Vec3 wi) const;
  /// The `axis().size()` values of one row.
  [[nodiscard]] const float* spectrum(std::uint32_t row) const;
  [[nodiscard]] const SpectralAxis& axis() const;
  /// MeasuredTables::last_measured_theta_i() of the whole tables [rad]: wo beyond it is extrapolated.
  [[nodiscard]] float last_measured_theta_i() const;
  [[nodiscard]] const MeasuredTables& tables() const;  ///< with empty `spectra`: they live re-ordered in here

 private:
  struct Data;
  std::shared_ptr<const Data> data_;
};

static_assert(Bsdf<MeasuredBrdf>);

}  // namespace spectrace
