// SPDX-License-Identifier: Apache-2.0
#include "separation/spectral_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include "core/math/math.h"
#include "separation/log_block.h"
#include "separation/log_root.h"
#include "separation/parallel.h"
#include "separation/spectral_sums.h"
#include "separation/supported_colour.h"
#include "separation/two_lobe_fit.h"

namespace spectrace {
namespace {

// A whole spectrum's worth of s_sun drawn into s_fresnel where no direction tells: as weak as may be, since a
// theta_d has up to 16,200 directions.
constexpr double kFresnelPrior = 1;

// How far above s_sun the spectra of a direction may lie (and above 1, where s_sun lies below). Beyond it are
// only cells whose rho_s is all but 0 (up to 250 were seen, where an exact Lambert lobe is brighter than the
// mean and darker than one channel); interpolation would multiply such an s with a neighbour's rho_s.
constexpr float kHighestOverSun = 16;

// As in step 1: one cell in seven leads to the neighbourhood of a solution, which all cells then decide.
constexpr std::size_t kScoutStride = 7;

// Wavelengths whose X is held at once: 256 MB on the paper's grid.
constexpr std::size_t kStripsPerBlock = 4;

Strip filled(float value) {
  Strip strip;
  strip.fill(value);
  return strip;
}

Strip highest_of(const Strip& s_sun) {
  Strip out;
  for (std::size_t k = 0; k < kStrip; ++k) out[k] = kHighestOverSun * std::max(s_sun[k], 1.0F);
  return out;
}

/// One strip of the axis, and everything its fits share.
struct StripFit {
  StripProblem whole;     ///< of eq. 18
  StripProblem compared;  ///< of eqs. 19 and 20: SpectralResidual
  std::size_t first = 0;  ///< of the axis
  int count = 0;          ///< wavelengths that exist
  Strip s_sun{};
};

struct Angles {
  std::size_t n_h, n_d;
  explicit Angles(const CellTable& table)
      : n_h(std::size_t(table.grid.n_theta_h)), n_d(std::size_t(table.grid.n_theta_d)) {}
};

/// eq. 18 where s_d is known already: one unknown per wavelength. Returns how many are unfinished.
int fit_sun(StripFit& strip, float highest) {
  const CellTable& table = strip.whole.table;
  const Angles angles(table);
  LogRoot root(filled(1), strip.count, 0, strip.whole.epsilon, filled(highest));
  std::vector<LogRootSums<double>> slices(angles.n_h);
  for (const std::size_t stride : {kScoutStride, std::size_t(1)}) {
    root.start_again(strip.count);
    while (!root.done()) {
      parallel_chunks(angles.n_h, [&](std::size_t h) {
        slices[h] = {};
        for (std::size_t group = h * angles.n_d; group < (h + 1) * angles.n_d; ++group) {
          slices[h].add(root_sums(strip.whole, cells_of_group(table, group, stride), root.at()));
        }
      });
      LogRootSums<double> sums;
      for (const LogRootSums<double>& slice : slices) sums.add(slice);
      root.step(sums);
    }
  }
  strip.s_sun = root.result();
  return root.unfinished();
}

/// eq. 19: one unknown per (theta_d, wavelength), drawn towards s_sun.
void fit_fresnel(const StripFit& strip, SpectralFit& fit) {
  const std::size_t axis_size = fit.s_d.size();
  const CellTable& table = strip.compared.table;
  const Angles angles(table);
  std::vector<int> unfinished(angles.n_d);
  parallel_chunks(angles.n_d, [&](std::size_t d) {
    LogRoot root(strip.s_sun, strip.count, kFresnelPrior, strip.compared.epsilon, highest_of(strip.s_sun));
    for (const std::size_t stride : {kScoutStride, std::size_t(1)}) {
      root.start_again(strip.count);
      while (!root.done()) {
        LogRootSums<double> sums;
        for (std::size_t h = 0; h < angles.n_h; ++h) {
          sums.add(root_sums(strip.compared, cells_of_group(table, h * angles.n_d + d, stride), root.at()));
        }
        root.step(sums);
      }
    }
    std::copy_n(root.result().begin(), strip.count, &fit.s_fresnel[d * axis_size + strip.first]);
    unfinished[d] = root.unfinished();
  });
  fit.unfinished = std::accumulate(unfinished.begin(), unfinished.end(), fit.unfinished);
}

using Squares = std::array<std::array<double, kStrip>, 3>;

/// eq. 20: one unknown per (theta_h, theta_d, wavelength), drawn towards s_fresnel; and what the three models
/// leave, while a cell's samples are in cache.
void fit_diffraction(const StripFit& strip, float prior, SpectralFit& fit) {
  const std::size_t axis_size = fit.s_d.size();
  const CellTable& table = strip.compared.table;
  const Angles angles(table);
  const Strip highest = highest_of(strip.s_sun);
  std::vector<Squares> slices(angles.n_h);
  std::vector<int> unfinished(angles.n_h);
  parallel_chunks(angles.n_h, [&](std::size_t h) {
    std::array<Strip, 3> s{strip.s_sun};
    for (std::size_t d = 0; d < angles.n_d; ++d) {
      const std::size_t group = h * angles.n_d + d;
      const CellRange cells = cells_of_group(table, group, 1);
      std::copy_n(&fit.s_fresnel[d * axis_size + strip.first], strip.count, s[1].begin());
      const GroupSolution found = solve_group(strip.compared, cells, s[1], strip.count, prior, highest);
      s[2] = found.s;
      unfinished[h] += found.unfinished;
      std::copy_n(s[2].begin(), strip.count, &fit.s_diffraction[group * axis_size + strip.first]);
      const std::array<Strip, 3> sums = squares(strip.whole, cells, s);
      for (std::size_t m = 0; m < 3; ++m) {
        for (std::size_t k = 0; k < kStrip; ++k) slices[h][m][k] += double(sums[m][k]);
      }
    }
  });
  fit.unfinished = std::accumulate(unfinished.begin(), unfinished.end(), fit.unfinished);
  const std::array<std::vector<double>*, 3> rms{&fit.rms_sun, &fit.rms_fresnel, &fit.rms_diffraction};
  for (std::size_t m = 0; m < 3; ++m) {
    for (std::size_t k = 0; k < std::size_t(strip.count); ++k) {
      double sum = 0;
      for (const Squares& slice : slices) sum += slice[m][k];
      (*rms[m])[strip.first + k] = std::sqrt(sum / double(table.fitted()));
    }
  }
}

/// s_d and s_sun. `is_bounded`: no colour brighter than the measurement supports.
void fit_eq_18(StripFit& strip, const std::vector<float>& s_d, bool is_bounded, SpectralFit& fit) {
  // A lone lit wavelength has as many as the axis; twice that for its fit.
  const float highest = 2 * static_cast<float>(fit.s_d.size());
  if (s_d.empty()) {
    const TwoLobes two = fit_two_lobes(strip.whole, strip.count);
    strip.whole.s_d = two.s_d;
    strip.s_sun = two.s_s;
    fit.unfinished += two.unfinished;
    if (is_bounded && support_colour(strip.whole, strip.count)) fit.unfinished += fit_sun(strip, highest);
  } else {
    std::copy_n(&s_d[strip.first], strip.count, strip.whole.s_d.begin());
    fit.unfinished += fit_sun(strip, highest);
  }
  strip.compared.s_d = strip.whole.s_d;
  std::copy_n(strip.whole.s_d.begin(), strip.count, &fit.s_d[strip.first]);
  std::copy_n(strip.s_sun.begin(), strip.count, &fit.s_sun[strip.first]);
}

LobeWeights lobe_weights(const CellTable& table, const SplitResult& split) {
  LobeWeights lobes{.diffuse = std::vector<float>(table.fitted()),
                    .specular = std::vector<float>(table.fitted())};
  const double lambert = split.albedo_d / kPi64;
  for (std::size_t i = 0; i < table.fitted(); ++i) {
    const double w = double(table.weight[i]);
    const double shape = split.diffuse_shape.empty() ? 1.0 : double(split.diffuse_shape[table.cell[i]]);
    lobes.diffuse[i] = static_cast<float>(lambert * shape * w);
    lobes.specular[i] = static_cast<float>(double(split.rho_s[table.cell[i]]) / table.cos_sum(i) * w);
  }
  return lobes;
}

/// Some strips of the axis: all models, then their residuals.
class BlockFit {
 public:
  BlockFit(const CellTable& table, const LobeWeights& lobes, const std::vector<float>& s_d, bool is_bounded,
           const SeparationOptions& options, SpectralFit& fit)
      : table_(table), lobes_(lobes), s_d_(s_d), is_bounded_(is_bounded), options_(options), fit_(fit) {}

  void run(const PaddedSpectra& spectra, std::size_t first_strip, std::size_t strips, LogBlock& data,
           LogBlock& remainder) const {
    const std::size_t n = fit_.s_d.size();
    data.fill(spectra, table_, first_strip, strips, options_.epsilon);
    std::vector<StripFit> fits;
    for (std::size_t i = 0; i < strips; ++i) {
      const std::size_t first = (first_strip + i) * kStrip;
      const StripProblem problem{.table = table_,
                                 .diffuse = lobes_.diffuse.data(),
                                 .specular = lobes_.specular.data(),
                                 .log_data = data.strip(i),
                                 .epsilon = static_cast<float>(options_.epsilon)};
      fits.push_back({.whole = problem,
                      .compared = problem,
                      .first = first,
                      .count = static_cast<int>(std::min(kStrip, n - first))});
      fit_eq_18(fits.back(), s_d_, is_bounded_, fit_);
    }
    if (options_.residual == SpectralResidual::kPrinted) {
      std::vector<Strip> s_d;
      for (const StripFit& strip : fits) s_d.push_back(strip.whole.s_d);
      remainder.fill_remainder(spectra, table_, first_strip, s_d, lobes_, options_.epsilon);
      for (std::size_t i = 0; i < strips; ++i) {
        fits[i].compared.s_d = {};
        fits[i].compared.log_data = remainder.strip(i);
      }
    }
    for (const StripFit& strip : fits) {
      fit_fresnel(strip, fit_);
      fit_diffraction(strip, static_cast<float>(options_.diffraction_prior), fit_);
    }
  }

 private:
  const CellTable& table_;
  const LobeWeights& lobes_;
  const std::vector<float>& s_d_;
  bool is_bounded_;
  const SeparationOptions& options_;
  SpectralFit& fit_;
};

}  // namespace

SpectralFit fit_spectra(const MeasuredBrdf& measured, const CellTable& table, const SplitResult& split,
                        const std::vector<float>& s_d, const SeparationOptions& options, Progress& progress) {
  const std::size_t n = measured.axis().size();
  SpectralFit fit{.s_d = std::vector<float>(n),
                  .s_sun = std::vector<float>(n),
                  .s_fresnel = std::vector<float>(std::size_t(table.grid.n_theta_d) * n),
                  .s_diffraction = std::vector<float>(table.grid.angular_size() * n),
                  .rms_sun = std::vector<double>(n),
                  .rms_fresnel = std::vector<double>(n),
                  .rms_diffraction = std::vector<double>(n)};
  if (table.fitted() == 0) return fit;
  const LobeWeights lobes = lobe_weights(table, split);
  const PaddedSpectra spectra(measured);
  const std::size_t blocks = (spectra.strips() + kStripsPerBlock - 1) / kStripsPerBlock;
  const std::size_t most = (spectra.strips() + blocks - 1) / blocks;
  LogBlock data(table.fitted(), most);
  LogBlock remainder(table.fitted(), options.residual == SpectralResidual::kPrinted ? most : 0);
  // What a lone diffuse lobe has too much is noise: no other lobe could take its place.
  const bool is_bounded = bounds_diffuse_lobe(options) && split.specular_share > 0;
  const BlockFit block(table, lobes, s_d, is_bounded, options, fit);
  for (std::size_t i = 0; i < blocks; ++i) {
    const std::size_t first = i * spectra.strips() / blocks, end = (i + 1) * spectra.strips() / blocks;
    block.run(spectra, first, end - first, data, remainder);
    progress.update("spectra", double(std::min(end * kStrip, n)), double(n));
  }
  return fit;
}

}  // namespace spectrace
