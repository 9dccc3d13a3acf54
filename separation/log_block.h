// SPDX-License-Identifier: Apache-2.0
// Some columns of the paper's X: few enough wavelengths for memory, in strips for the arithmetic to
// vectorise.
#pragma once

#include <cstddef>
#include <vector>

#include "separation/cell_table.h"
#include "separation/log_root.h"

namespace spectrace {

/// The spectra of a measurement, each padded with zeros to a whole number of strips.
class PaddedSpectra {
 public:
  explicit PaddedSpectra(const MeasuredBrdf& measured);

  [[nodiscard]] std::size_t strips() const { return strips_; }
  [[nodiscard]] const float* at(std::uint32_t row, std::size_t strip) const {
    return &values_[(row * strips_ + strip) * kStrip];
  }

 private:
  std::size_t strips_;
  std::vector<float> values_;
};

/// f̂ w of one fitted cell at one strip: Σ weight · spectrum over its nodes.
SPECTRACE_KERNEL inline Strip sum_of_nodes(const PaddedSpectra& spectra, const CellTable& table,
                                           std::size_t cell, std::size_t strip) {
  Strip sum{};
  for (std::size_t n = table.node_begin[cell]; n < table.node_begin[cell + 1]; ++n) {
    const float weight = table.node_weight[n];
    const float* const from = spectra.at(table.node_row[n], strip);
    for (std::size_t k = 0; k < kStrip; ++k) sum[k] += weight * from[k];
  }
  return sum;
}

/// s_d and s_s of eq. 18 multiply these, w included.
struct LobeWeights {
  std::vector<float> diffuse, specular;  ///< [fitted]
};

/// ln(f̂ w + ε) of the fitted cells at up to `strips` strips of wavelengths.
class LogBlock {
 public:
  LogBlock(std::size_t cells, std::size_t strips) : cells_(cells), values_(cells * strips * kStrip) {}

  /// kStrip values a cell, cells one after another; `strip` counts within the block.
  [[nodiscard]] const float* strip(std::size_t strip) const { return &values_[strip * cells_ * kStrip]; }

  void fill(const PaddedSpectra& spectra, const CellTable& table, std::size_t first_strip, std::size_t strips,
            double epsilon);
  /// The same of what the diffuse lobe leaves, ln(max(f̂ w - s_d ρ_d w, 0) + ε); `s_d`: [strip].
  void fill_remainder(const PaddedSpectra& spectra, const CellTable& table, std::size_t first_strip,
                      const std::vector<Strip>& s_d, const LobeWeights& lobes, double epsilon);

 private:
  std::size_t cells_;
  std::vector<float> values_;
};

}  // namespace spectrace
