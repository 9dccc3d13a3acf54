// SPDX-License-Identifier: Apache-2.0
#include "separation/analytic_spectra.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "separation/fast_log.h"
#include "separation/parallel.h"

namespace spectrace {
namespace {

/// ln(f̂ w + ε) of one strip of wavelengths at every kAnalyticStride-th cell, [strip][cell].
std::vector<std::vector<float>> log_data(const PaddedSpectra& spectra, const CellTable& table,
                                         std::size_t strip, double epsilon) {
  const std::size_t cells = (table.fitted() + kAnalyticStride - 1) / kAnalyticStride;
  std::vector<std::vector<float>> out(kStrip, std::vector<float>(cells));
  for (std::size_t c = 0; c < cells; ++c) {
    const Strip sum = sum_of_nodes(spectra, table, c * kAnalyticStride, strip);
    for (std::size_t k = 0; k < kStrip; ++k) out[k][c] = fast_log(sum[k] + static_cast<float>(epsilon));
  }
  return out;
}

}  // namespace

AnalyticSpectra fit_analytic_spectra(const MeasuredBrdf& measured, const CellTable& table,
                                     const AnalyticFit& achromatic, const SeparationOptions& options) {
  const std::size_t n = measured.axis().size();
  const PaddedSpectra spectra(measured);
  const LobeCells part = lobe_cells(table, options.epsilon, kAnalyticStride);
  AnalyticSpectra out{.parameters = std::vector<float>(4 * n), .rms = std::vector<double>(n)};
  parallel_chunks(spectra.strips(), [&](std::size_t strip) {
    std::vector<std::vector<float>> data = log_data(spectra, table, strip, options.epsilon);
    LobeCells cells = part;
    AnalyticFit start = achromatic;
    for (std::size_t k = strip * kStrip; k < std::min((strip + 1) * kStrip, n); ++k) {
      cells.log_data.swap(data[k % kStrip]);
      const auto [fit, cost] = refine_analytic(cells, options, start);
      out.parameters[k] = static_cast<float>(fit.albedo_d);
      out.parameters[n + k] = static_cast<float>(fit.rho_0);
      out.parameters[2 * n + k] = static_cast<float>(fit.f_0);
      out.parameters[3 * n + k] = static_cast<float>(fit.alpha);
      out.rms[k] = std::sqrt(2 * cost / double(std::max<std::size_t>(cells.size(), 1)));
      start = fit.rho_0 > 0 ? fit : achromatic;  // without a lobe its roughness says nothing
    }
  });
  return out;
}

}  // namespace spectrace
