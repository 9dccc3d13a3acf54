// SPDX-License-Identifier: Apache-2.0
// Finds the sigmoid spectrum of a colour: the solver behind core/spectra/rgb_uplift.h and its table.
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "core/spectra/spectrum.h"

namespace spectrace {

/// S(x) = 1/2 + x / (2 sqrt(1 + x²)), from its smaller side, S(-|x|), by the form in which nothing cancels;
/// the other is 1 less that. Without branches: lanes are computed together.
template <typename T>
T sigmoid(T x) {
  const T r = std::sqrt(1 + x * x);
  const T below = T(0.5) / (r * (r + std::abs(x)));
  return x < 0 ? below : 1 - below;
}
/// Greys closer to 0 or 1 than this are held here, where the sigmoid is within a float's rounding of its
/// limit.
inline constexpr double kGreyMargin = 1e-9;
/// The x with S(x) = y, for y in (0, 1).
double inverse_sigmoid(double y);

using SigmoidCoefficients = std::array<double, 3>;

/// Solves for the coefficients whose reflectance under D65 has a given colour. Immutable.
class SigmoidFitter {
 public:
  /// The quadrature of reflectance_to_xyz() with spectra taken at every `step_nm` (a divisor of 5) and linear
  /// in between: 1 is that quadrature itself, 5 is five times faster and good to 1e-4 for spectra as smooth
  /// as these.
  explicit SigmoidFitter(int step_nm);

  struct Fit {
    SigmoidCoefficients c{};
    double delta_e = 0;  ///< what remains: distance in CIELAB, white L* = 100
  };
  /// Levenberg-Marquardt on the CIELAB residual from `start`. `rgb` in [0, 1].
  [[nodiscard]] Fit fit(const Rgb& rgb, const SigmoidCoefficients& start) const;
  /// From grey, by steps towards `rgb` where one leap does not arrive.
  [[nodiscard]] Fit fit(const Rgb& rgb) const;
  [[nodiscard]] Rgb color_of(const SigmoidCoefficients& c) const;

 private:
  struct Node {
    double t = 0;  // the sigmoid's variable
    Xyz weight{};  // of a reflectance here in XYZ
  };
  struct Residual;
  [[nodiscard]] Residual residual(const SigmoidCoefficients& c, const Xyz& target_lab) const;

  std::vector<Node> nodes_;
  Xyz white_{};
};

}  // namespace spectrace
