// SPDX-License-Identifier: Apache-2.0
// Spectra measured at scattered pairs of directions: the Cornell gonioreflectometer's `.brdf` text, and what
// carries them to all other directions.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "materials/acquisition.h"

namespace spectrace {

struct ScatteredSamples {
  struct Directions {
    double theta_i = 0, phi_i = 0, theta_o = 0, phi_o = 0;  ///< [rad], theta in [0, π/2]
  };
  std::vector<float> lambda_nm;  ///< increasing
  std::vector<Directions> directions;
  std::vector<float> f;             ///< [sample][wavelength] [1/sr], >= 0
  std::size_t negative_values = 0;  ///< of `f`, clamped to 0
};

/// True where the text begins like such a file: comments, then the number of wavelengths.
bool is_scattered_text(std::string_view text);
/// `#` begins a comment. First the number of wavelengths and the wavelengths [nm]; then a line a sample:
/// theta_i phi_i theta_o phi_o [rad] and f [1/sr] at every wavelength. Throws InputError, line:column.
ScatteredSamples parse_scattered(std::string_view text, const std::string& file_name);

/// An isotropic, reciprocal and mirror-symmetric BRDF through the samples: at any pair of directions a
/// weighted linear fit to ln(f + ε) of the nearest samples, clamped to their range. Near is told in
/// (√θh, 0.6 θd, sinθh sinθd |cos φd|): of those tried the one in which Cornell's paints predict samples left
/// out best (docs/bring-your-own-data.md).
class ScatteredBrdf final : public BrdfSource {
 public:
  explicit ScatteredBrdf(const ScatteredSamples& samples);

  [[nodiscard]] const SpectralAxis& axis() const override { return axis_; }
  /// Known where a sample is no farther than most samples are from their nearest neighbour.
  bool read(Vec3 wo, Vec3 wi, std::span<float> value_cos) const override;
  [[nodiscard]] double near_radius() const { return near_radius_; }

  static constexpr std::size_t kNeighbours = 12;
  using Point = std::array<double, 3>;
  static Point point_of(Vec3 wo, Vec3 wi);

 private:
  struct Neighbour {
    double distance_squared = 0;
    std::size_t sample = 0;
  };
  using Neighbours = std::array<Neighbour, kNeighbours + 1>;  // the last one bounds the others' weights
  /// The nearest samples, none nearer than `beyond`, nearest first.
  [[nodiscard]] Neighbours nearest(const Point& at, double beyond) const;
  [[nodiscard]] double neighbour_quantile() const;

  SpectralAxis axis_;
  std::vector<Point> points_;      // by increasing first coordinate
  std::vector<float> log_values_;  // ln(f + ε), in the order of points_
  double near_radius_ = 0;
};

}  // namespace spectrace
