// SPDX-License-Identifier: Apache-2.0
#include "separation/log_block.h"

#include <algorithm>

#include "separation/fast_log.h"
#include "separation/instruction_set.h"
#include "separation/parallel.h"

namespace spectrace {
PaddedSpectra::PaddedSpectra(const MeasuredBrdf& measured)
    : strips_((measured.axis().size() + kStrip - 1) / kStrip) {
  const MeasuredTables& tables = measured.tables();
  const std::size_t rows = tables.slices() * std::size_t(tables.table_size) * std::size_t(tables.table_size);
  values_.resize(rows * strips_ * kStrip);
  for (std::size_t r = 0; r < rows; ++r) {
    std::copy_n(measured.spectrum(static_cast<std::uint32_t>(r)), measured.axis().size(),
                &values_[r * strips_ * kStrip]);
  }
}

void LogBlock::fill(const PaddedSpectra& spectra, const CellTable& table, std::size_t first_strip,
                    std::size_t strips, double epsilon) {
  const auto n_h = std::size_t(table.grid.n_theta_h), n_d = std::size_t(table.grid.n_theta_d);
  const auto eps = static_cast<float>(epsilon);
  parallel_chunks(n_h, [&](std::size_t h) {
    run_kernel([&]() SPECTRACE_KERNEL {
      for (std::size_t i = table.begin[h * n_d]; i < table.begin[(h + 1) * n_d]; ++i) {
        for (std::size_t strip = 0; strip < strips; ++strip) {
          const Strip sum = sum_of_nodes(spectra, table, i, first_strip + strip);
          float* const to = &values_[(strip * cells_ + i) * kStrip];
          for (std::size_t k = 0; k < kStrip; ++k) to[k] = fast_log(sum[k] + eps);
        }
      }
    });
  });
}

void LogBlock::fill_remainder(const PaddedSpectra& spectra, const CellTable& table, std::size_t first_strip,
                              const std::vector<Strip>& s_d, const LobeWeights& lobes, double epsilon) {
  const auto n_h = std::size_t(table.grid.n_theta_h), n_d = std::size_t(table.grid.n_theta_d);
  const auto eps = static_cast<float>(epsilon);
  parallel_chunks(n_h, [&](std::size_t h) {
    for (std::size_t i = table.begin[h * n_d]; i < table.begin[(h + 1) * n_d]; ++i) {
      for (std::size_t strip = 0; strip < s_d.size(); ++strip) {
        const Strip sum = sum_of_nodes(spectra, table, i, first_strip + strip);
        float* const to = &values_[(strip * cells_ + i) * kStrip];
        for (std::size_t k = 0; k < kStrip; ++k) {
          to[k] = fast_log(std::max(sum[k] - s_d[strip][k] * lobes.diffuse[i], 0.0F) + eps);
        }
      }
    }
  });
}

}  // namespace spectrace
