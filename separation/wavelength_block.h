// SPDX-License-Identifier: Apache-2.0
// Some columns of the paper's X: enough wavelengths for the arithmetic to vectorise, few enough for memory.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "separation/cell_table.h"
#include "separation/parallel.h"

namespace spectrace {

/// f̂ w of the fitted cells at B wavelengths, contiguous for each cell.
template <int B>
class WavelengthBlock {
 public:
  explicit WavelengthBlock(std::size_t cells) : values_(cells * B) {}

  [[nodiscard]] const float* row(std::size_t cell) const { return &values_[cell * B]; }

  /// Wavelengths [first, first + count) of the axis; the rest of the block becomes 0.
  void fill(const MeasuredBrdf& measured, const CellTable& table, std::size_t first, int count) {
    parallel_chunks(std::size_t(table.grid.n_theta_h), [&](std::size_t h) {
      const std::size_t n_d = std::size_t(table.grid.n_theta_d);
      for (std::size_t i = table.begin[h * n_d]; i < table.begin[(h + 1) * n_d]; ++i) {
        float* to = &values_[i * B];
        std::fill_n(to, B, 0.0F);
        for (std::size_t n = table.node_begin[i]; n < table.node_begin[i + 1]; ++n) {
          const float* from = measured.spectrum(table.node_row[n]) + first;
          const float weight = table.node_weight[n];
          if (count == B) {  // the constant trip count vectorises
            for (int k = 0; k < B; ++k) to[k] += weight * from[k];
          } else {
            for (int k = 0; k < count; ++k) to[k] += weight * from[k];
          }
        }
      }
    });
  }

 private:
  std::vector<float> values_;
};

/// s_d and s_s of eq. 18 multiply these, w included.
struct LobeWeights {
  std::vector<float> diffuse, specular;  ///< [fitted]
};

}  // namespace spectrace
