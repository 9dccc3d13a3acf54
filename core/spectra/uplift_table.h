// SPDX-License-Identifier: Apache-2.0
// Sigmoid coefficients over the RGB cube, tabulated when the program is built.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "core/spectra/sigmoid_fit.h"

namespace spectrace {

/// Three grids, one for each channel that may be the largest, over (largest; the next channel / largest; the
/// one after / largest), after Jakob & Hanika 2019, sec. 4. Three departures, which together bring the worst
/// round trip of a table with 32 nodes a side from 3e-2 to 2e-3: what is stored is c · sqrt(largest), which
/// stays finite and smooth towards black, where S(x) -> 1/(4x²); only colours with largest + smallest <= 1
/// are looked up, the others through S(-x) = 1 - S(x) as the complement of their complement, so that white is
/// as tame as black; and all three axes are finer at both ends.
class UpliftTable {
 public:
  static constexpr int kSize = 36;  // worst round trip 1.5e-3; 24 has 3.5e-3, and 48 twice the size
  static constexpr std::size_t kFloats = std::size_t(3) * kSize * kSize * kSize * 3;

  /// `coefficients`: kFloats of them, which must live as long as the table.
  explicit UpliftTable(std::span<const float> coefficients) : c_(coefficients) {}
  /// The table compiled into the program.
  static const UpliftTable& built_in();
  /// Solves for every node: seconds of work.
  static std::vector<float> build();

  /// `rgb` in [0, 1], not black.
  [[nodiscard]] SigmoidCoefficients lookup(const Rgb& rgb) const;

 private:
  std::span<const float> c_;  // [largest][value][second ratio][first ratio][3]
};

}  // namespace spectrace
