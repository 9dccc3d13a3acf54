// SPDX-License-Identifier: Apache-2.0
// How much of the light that meets a clear GGX coat is reflected at once.
#pragma once

#include <vector>

#include "core/base/float.h"

namespace spectrace {

/// No clear coat has a higher index: germanium's, in the infrared.
inline constexpr Float kMaxCoatEta = 4;

/// Directional albedo E(cosθ, η) of F D G2 / (4 cosθi cosθo), in air over a medium of index η, and its mean.
/// The ratio to the Fresnel reflectance of the plane coat is tabulated: smooth in both, 1 at alpha = 0.
class CoatAlbedo {
 public:
  /// 1 <= eta_min <= eta_max <= kMaxCoatEta; `alpha` 0 (a mirror) or in [kMinAlpha, 1].
  CoatAlbedo(Float alpha, Float eta_min, Float eta_max);

  /// `cosine` in [0, 1].
  [[nodiscard]] Float at(Float cosine, Float eta) const;
  /// 2 ∫ E(c) c dc over [0, 1]: of diffuse light.
  [[nodiscard]] Float average(Float eta) const;

 private:
  /// The two rows around an index, and the weight of the second.
  struct Rows {
    std::size_t first = 0, second = 0;
    Float weight = 0;
  };
  [[nodiscard]] Rows rows(Float eta) const;
  [[nodiscard]] Float ratio(std::size_t row, Float cosine) const;
  [[nodiscard]] Float eta_of(std::size_t row) const;
  void tabulate(Float alpha);

  std::size_t rows_ = 1;
  Float eta_min_ = 1, eta_step_ = 0;
  std::vector<float> ratios_;  // [row][cosine node]; empty where alpha = 0
  std::vector<float> averages_;
};

}  // namespace spectrace
