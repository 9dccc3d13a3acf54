// SPDX-License-Identifier: Apache-2.0
// Light from infinitely far: constant, or a latitude-longitude image sampled where it is bright.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "core/image/image.h"
#include "core/image/spectral_image.h"
#include "core/math/vec.h"
#include "core/spectra/rgb_uplift.h"
#include "core/spectra/spectrum.h"
#include "renderer/geometry.h"

namespace spectrace {

/// A density over the unit square, constant on each cell of a grid.
class GridDensity {
 public:
  struct Sample {
    Vec2 position;
    Float pdf = 0;  ///< per unit square area
  };
  GridDensity() = default;
  /// `weights` row by row, width · height of them, >= 0 and finite (checked); all zero counts as all equal.
  GridDensity(int width, int height, const std::vector<double>& weights);
  [[nodiscard]] Sample sample(Vec2 u) const;
  [[nodiscard]] Float pdf(Vec2 position) const;

 private:
  int width_ = 1, height_ = 1;
  std::vector<float> rows_;   // cumulative over rows, [height + 1]
  std::vector<float> cells_;  // cumulative along each row, [height][width + 1]
};

/// Image convention: row 0 is +z, the middle column +x, columns run clockwise seen from above (towards -y),
/// so that an image seen from inside is not mirrored: u = 1/2 - atan2(y, x) / 2π, v = acos(z) / π.
class Environment {
 public:
  /// Constant.
  explicit Environment(Spectrum radiance);
  /// `radiance` · image, turned by `to_world` (a rotation). The image's spectra (channels "S0.550,000000nm",
  /// ...) are taken where it has them, else R, G, B. Throws InputError where it has neither or a texel is
  /// negative or not finite, naming `file`.
  Environment(const Image& image, const std::filesystem::path& file, Spectrum radiance,
              const Transform& to_world);

  struct Sample {
    Vec3 wi;        ///< unit, world
    Float pdf = 0;  ///< per solid angle [1/sr], > 0
  };
  [[nodiscard]] SampledSpectrum radiance(Vec3 direction, const SampledWavelengths& lambda) const;
  /// In proportion to how much brighter than the mean the image is: what is darker is left to BSDF sampling.
  /// nullopt everywhere where sampled_share() is 0.
  [[nodiscard]] std::optional<Sample> sample(Vec2 u) const;
  /// The density of sample() returning unit `direction`.
  [[nodiscard]] Float pdf(Vec3 direction) const;

  /// Mean over all directions: for the choice between lights.
  [[nodiscard]] Float mean_radiance(Float lambda_nm) const;
  /// Of its light that sample() is after, in [0, 1): 0 of a constant one.
  [[nodiscard]] double sampled_share() const { return sampled_share_; }
  [[nodiscard]] bool is_image() const { return width_ > 0; }

 private:
  /// Both fill the texels and return their luminance.
  std::vector<double> take_rgb(const Image& image, const std::string& file);
  std::vector<double> take_spectra(SpectralImage spectra, const std::string& file);

  Spectrum radiance_;
  int width_ = 0, height_ = 0;
  std::vector<SigmoidSpectrum> texels_;             // without the illuminant, which is one factor for all
  std::optional<SpectralImage> spectra_;            // instead of texels_
  std::optional<TabulatedSpectrum> mean_spectrum_;  // of spectra_, over all directions
  double mean_luminance_ = 1;
  double sampled_share_ = 0;
  Frame axes_;  // the image's x, y, z in the world
  GridDensity density_;
};

}  // namespace spectrace
