// SPDX-License-Identifier: Apache-2.0
// The MERL database's `.binary` (Matusik et al. 2003): three colours over 90 x 90 x 180 half-difference
// angles.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "materials/acquisition.h"
#include "materials/half_difference_grid.h"

namespace spectrace {

/// True where the bytes begin with the dimensions of such a file.
bool is_merl(std::span<const std::byte> bytes);

/// Isotropic and reciprocal by its coordinates. Values are taken for those at the bins' lower corners, as the
/// database's own reader takes them, and read trilinearly between; its RGB is taken for linear sRGB.
class MerlBrdf final : public BrdfSource {
 public:
  /// Throws InputError naming the byte and the field: wrong dimensions or size, a value that is not finite.
  MerlBrdf(std::span<const std::byte> bytes, const std::string& file_name);

  [[nodiscard]] const SpectralAxis& axis() const override { return axis_; }
  /// Known where at least half the weight lies on valid bins; the rest of it then counts for nothing. Where
  /// no bin around is valid, 0.
  bool read(Vec3 wo, Vec3 wi, std::span<float> value_cos) const override;

  [[nodiscard]] std::size_t bins() const { return values_.size(); }
  [[nodiscard]] std::size_t invalid_bins() const { return invalid_; }  ///< a channel below 0

 private:
  SpectralAxis axis_ = SpectralAxis::rgb();
  HalfDifferenceGrid grid_;                   // 90 x 90 x 180, quadratic: the file's
  std::vector<std::array<float, 3>> values_;  // f [1/sr]; below 0 where invalid
  std::size_t invalid_ = 0;
};

}  // namespace spectrace
