// SPDX-License-Identifier: Apache-2.0
// A measured BRDF evaluated slowly and plainly in double precision, straight from the file's tables: what the
// program's own evaluation is held against. Shares no code with it but the reader.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/math/vec.h"
#include "materials/measured_tables.h"

namespace spectrace::test {

class MeasuredReference {
 public:
  explicit MeasuredReference(const MeasuredTables& tables);

  struct Value {
    std::vector<double> value_cos;  ///< f·cosθi [1/sr], one for each wavelength asked for
    double pdf = 0;                 ///< [1/sr]
  };
  /// Both directions above the horizon.
  [[nodiscard]] Value evaluate(Vec3 wo, Vec3 wi, std::span<const double> lambda_nm) const;

 private:
  struct Slices {  // indices into [phi_i][theta_i] and their weights
    std::vector<std::size_t> index;
    std::vector<double> weight;
  };
  struct Grid {
    int width = 0, height = 0;
    std::vector<std::vector<double>> slices;  // each row by row, integrating to 1 where it is a density
    [[nodiscard]] double at(const Slices& which, double x, double y) const;
  };
  struct Angles {
    double theta_i, phi_i, theta_m, phi_m;
  };
  [[nodiscard]] Angles angles(Vec3 wo, Vec3 wi) const;
  [[nodiscard]] Slices slices(double phi_i, double theta_i) const;
  /// The stored value of one channel at the unit-square position (x, y).
  [[nodiscard]] double channel(const Slices& which, std::size_t k, double x, double y) const;
  [[nodiscard]] double colour(const Slices& which, double lambda_nm, double x, double y) const;
  /// Share of the density of `vndf` below (x, y): first over rows up to y, then along the row at y up to x.
  [[nodiscard]] std::array<double, 2> inverse(const Slices& which, double x, double y) const;

  const MeasuredTables& tables_;
  Grid ndf_, sigma_, vndf_, sampling_;
  std::vector<std::vector<double>> vndf_row_mass_;
};

}  // namespace spectrace::test
