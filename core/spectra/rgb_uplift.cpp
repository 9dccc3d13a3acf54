// SPDX-License-Identifier: Apache-2.0
#include "core/spectra/rgb_uplift.h"

#include <algorithm>
#include <cstddef>
#include <limits>

#include "core/spectra/sigmoid_fit.h"
#include "core/spectra/uplift_table.h"

namespace spectrace {
namespace {

Rgb clamped(const Rgb& rgb, double max) {
  Rgb r{};
  for (std::size_t c = 0; c < 3; ++c) r[c] = rgb[c] > 0 ? std::min(rgb[c], max) : 0;
  return r;
}

SigmoidSpectrum to_spectrum(const SigmoidCoefficients& c) {
  return {{static_cast<Float>(c[0]), static_cast<Float>(c[1]), static_cast<Float>(c[2])}, 1};
}

bool is_black(const Rgb& rgb) { return rgb == Rgb{0, 0, 0}; }

// No sigmoid is 0 everywhere.
constexpr SigmoidSpectrum kBlack{{0, 0, 0}, 0};

template <typename Uplift>
RgbIlluminantSpectrum scaled_uplift(const Rgb& rgb, const Uplift& uplift) {
  const Rgb positive = clamped(rgb, std::numeric_limits<double>::max());
  const double scale = 2 * *std::max_element(positive.begin(), positive.end());
  if (scale == 0) return {kBlack};
  SigmoidSpectrum sigmoid = uplift({positive[0] / scale, positive[1] / scale, positive[2] / scale});
  sigmoid.scale = static_cast<Float>(scale);
  return {sigmoid};
}

}  // namespace

SigmoidSpectrum uplift_reflectance(const Rgb& rgb) {
  static const SigmoidFitter fitter(1);
  const Rgb inside = clamped(rgb, 1);
  return is_black(inside) ? kBlack : to_spectrum(fitter.fit(inside).c);
}

SigmoidSpectrum uplift_reflectance_fast(const Rgb& rgb) {
  const Rgb inside = clamped(rgb, 1);
  return is_black(inside) ? kBlack : to_spectrum(UpliftTable::built_in().lookup(inside));
}

RgbIlluminantSpectrum uplift_emission(const Rgb& rgb) { return scaled_uplift(rgb, uplift_reflectance); }
SigmoidSpectrum uplift_factor(const Rgb& rgb) { return uplift_emission(rgb).sigmoid; }
RgbIlluminantSpectrum uplift_emission_fast(const Rgb& rgb) {
  return scaled_uplift(rgb, uplift_reflectance_fast);
}

}  // namespace spectrace
