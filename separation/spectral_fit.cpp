// SPDX-License-Identifier: Apache-2.0
#include "separation/spectral_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>

#include "separation/log_root.h"
#include "separation/parallel.h"
#include "separation/two_lobe_fit.h"
#include "separation/wavelength_block.h"

namespace spectrace {
namespace {

// A whole spectrum's worth of s_sun drawn into s_fresnel where no direction tells: as weak as may be, since a
// theta_d has up to 16,200 directions.
constexpr double kFresnelPrior = 1;

// How far above s_sun the spectra of a direction may lie (and above 1, where s_sun lies below). Beyond it are
// only cells whose rho_s is all but 0 (up to 250 were seen, where an exact Lambert lobe is brighter than the
// mean and darker than one channel); interpolation would multiply such an s with a neighbour's rho_s.
constexpr float kHighestOverSun = 16;

template <int B>
std::array<float, std::size_t(B)> filled(float value) {
  std::array<float, B> out{};
  out.fill(value);
  return out;
}

template <int B>
std::array<float, std::size_t(B)> highest_of(const std::array<float, std::size_t(B)>& s_sun) {
  std::array<float, B> out{};
  for (int k = 0; k < B; ++k) out[k] = kHighestOverSun * std::max(s_sun[k], 1.0F);
  return out;
}

/// Everything the fits of one block share.
template <int B>
struct Context {
  const CellTable& table;
  const LobeWeights& lobes;
  WavelengthBlock<B> block;
  double epsilon = 0, prior = 0;
  float highest_sun = 0;  ///< no s_sun is larger: its mean over the axis is 1
  bool whole = true;      ///< SpectralResidual::kWhole
  std::size_t first = 0;  ///< of the axis
  int count = 0;          ///< wavelengths of this block that exist
  std::array<float, B> s_d{}, s_sun{};
};

/// Adds the samples of one (theta_h, theta_d) to the sums of a root search at `s`.
template <int B, bool kWhole>
void add_samples(const Context<B>& c, std::size_t group, const std::array<float, B>& s,
                 LogRootSums<B>& sums) {
  const auto epsilon = static_cast<float>(c.epsilon);
  std::array<float, B> gradient{}, information{};
  for (std::size_t i = c.table.begin[group]; i < c.table.begin[group + 1]; ++i) {
    const float a = c.lobes.diffuse[i], b = c.lobes.specular[i];
    const float* x = c.block.row(i);
    for (int k = 0; k < B; ++k) {
      const float diffuse = c.s_d[k] * a, specular = s[k] * b;
      // As printed the argument of eqs. 19 and 20 may be negative: clamped.
      const float data = (kWhole ? x[k] : std::max(x[k] - diffuse, 0.0F)) + epsilon;
      const float inverse = 1 / ((kWhole ? diffuse + specular : specular) + epsilon);
      const float r = fast_log(data * inverse), u = specular * inverse;
      gradient[k] += r * u;
      information[k] += u * u;
    }
  }
  for (int k = 0; k < B; ++k) {
    sums.gradient[k] += double(gradient[k]);
    sums.information[k] += double(information[k]);
  }
}

template <int B>
void add_samples(const Context<B>& c, std::size_t group, const std::array<float, B>& s,
                 LogRootSums<B>& sums) {
  c.whole ? add_samples<B, true>(c, group, s, sums) : add_samples<B, false>(c, group, s, sums);
}

/// eq. 18 where s_d is known already: one unknown per wavelength.
template <int B>
void fit_sun(Context<B>& c) {
  const auto n_h = std::size_t(c.table.grid.n_theta_h), n_d = std::size_t(c.table.grid.n_theta_d);
  std::array<float, B> start{};
  start.fill(1);
  LogRoot<B> root(start, c.count, 0, c.epsilon, filled<B>(c.highest_sun));
  std::vector<LogRootSums<B>> slices(n_h);
  while (!root.done()) {
    parallel_chunks(n_h, [&](std::size_t h) {
      slices[h] = {};
      for (std::size_t d = 0; d < n_d; ++d) add_samples<B>(c, h * n_d + d, root.at(), slices[h]);
    });
    LogRootSums<B> sums;
    for (const LogRootSums<B>& slice : slices) {
      for (int k = 0; k < B; ++k) {
        sums.gradient[k] += slice.gradient[k];
        sums.information[k] += slice.information[k];
      }
    }
    root.step(sums);
  }
  c.s_sun = root.result();
}

/// eq. 19: one unknown per (theta_d, wavelength), drawn towards s_sun.
template <int B>
void fit_fresnel(const Context<B>& c, SpectralFit& fit, std::size_t axis_size) {
  const auto n_h = std::size_t(c.table.grid.n_theta_h), n_d = std::size_t(c.table.grid.n_theta_d);
  parallel_chunks(n_d, [&](std::size_t d) {
    LogRoot<B> root(c.s_sun, c.count, kFresnelPrior, c.epsilon, highest_of<B>(c.s_sun));
    while (!root.done()) {
      LogRootSums<B> sums;
      for (std::size_t h = 0; h < n_h; ++h) add_samples<B>(c, h * n_d + d, root.at(), sums);
      root.step(sums);
    }
    std::copy_n(root.result().begin(), c.count, &fit.s_fresnel[d * axis_size + c.first]);
  });
}

/// eq. 20: one unknown per (theta_h, theta_d, wavelength), drawn towards s_fresnel.
template <int B>
void fit_diffraction(const Context<B>& c, SpectralFit& fit, std::size_t axis_size) {
  const auto n_h = std::size_t(c.table.grid.n_theta_h), n_d = std::size_t(c.table.grid.n_theta_d);
  parallel_chunks(n_h, [&](std::size_t h) {
    for (std::size_t d = 0; d < n_d; ++d) {
      std::array<float, B> s_fresnel{};
      std::copy_n(&fit.s_fresnel[d * axis_size + c.first], c.count, s_fresnel.begin());
      LogRoot<B> root(s_fresnel, c.count, c.prior, c.epsilon, highest_of<B>(c.s_sun));
      while (!root.done()) {
        LogRootSums<B> sums;
        add_samples<B>(c, h * n_d + d, root.at(), sums);
        root.step(sums);
      }
      std::copy_n(root.result().begin(), c.count, &fit.s_diffraction[(h * n_d + d) * axis_size + c.first]);
    }
  });
}

template <int B>
using Squares = std::array<std::array<double, B>, 3>;

/// Σ r² of the three models over one (theta_h, theta_d).
template <int B>
void add_squares(const Context<B>& c, std::size_t group, const std::array<std::array<float, B>, 3>& s,
                 Squares<B>& squares) {
  const auto epsilon = static_cast<float>(c.epsilon);
  std::array<std::array<float, B>, 3> sums{};
  for (std::size_t i = c.table.begin[group]; i < c.table.begin[group + 1]; ++i) {
    const float a = c.lobes.diffuse[i], b = c.lobes.specular[i];
    const float* x = c.block.row(i);
    for (std::size_t m = 0; m < 3; ++m) {
      for (int k = 0; k < B; ++k) {
        const float r = fast_log((x[k] + epsilon) / (c.s_d[k] * a + s[m][k] * b + epsilon));
        sums[m][k] += r * r;
      }
    }
  }
  for (std::size_t m = 0; m < 3; ++m) {
    for (int k = 0; k < B; ++k) squares[m][k] += double(sums[m][k]);
  }
}

template <int B>
void measure_residuals(const Context<B>& c, SpectralFit& fit, std::size_t axis_size) {
  const auto n_h = std::size_t(c.table.grid.n_theta_h), n_d = std::size_t(c.table.grid.n_theta_d);
  std::vector<Squares<B>> slices(n_h);
  parallel_chunks(n_h, [&](std::size_t h) {
    std::array<std::array<float, B>, 3> s{c.s_sun};
    for (std::size_t d = 0; d < n_d; ++d) {
      std::copy_n(&fit.s_fresnel[d * axis_size + c.first], c.count, s[1].begin());
      std::copy_n(&fit.s_diffraction[(h * n_d + d) * axis_size + c.first], c.count, s[2].begin());
      add_squares<B>(c, h * n_d + d, s, slices[h]);
    }
  });
  const std::array<std::vector<double>*, 3> rms{&fit.rms_sun, &fit.rms_fresnel, &fit.rms_diffraction};
  for (std::size_t m = 0; m < 3; ++m) {
    for (int k = 0; k < c.count; ++k) {
      double sum = 0;
      for (const Squares<B>& slice : slices) sum += slice[m][k];
      (*rms[m])[c.first + std::size_t(k)] = std::sqrt(sum / double(c.table.fitted()));
    }
  }
}

template <int B>
void fit_blocks(const MeasuredBrdf& measured, const CellTable& table, const LobeWeights& lobes,
                const std::vector<float>& s_d, const SeparationOptions& options, Progress& progress,
                SpectralFit& fit) {
  const std::size_t n = measured.axis().size();
  Context<B> c{
      .table = table,
      .lobes = lobes,
      .block = WavelengthBlock<B>(table.fitted()),
      .epsilon = options.epsilon,
      .prior = options.diffraction_prior,
      .highest_sun = 2 * static_cast<float>(n),  // a lone lit wavelength has n; twice that for its fit
      .whole = options.residual == SpectralResidual::kWhole};
  for (std::size_t first = 0; first < n; first += B) {
    c.first = first;
    c.count = static_cast<int>(std::min<std::size_t>(B, n - first));
    c.block.fill(measured, table, first, c.count);
    if (s_d.empty()) {
      const TwoLobes<B> two = fit_two_lobes<B>(table, lobes, c.block, c.count, options.epsilon);
      c.s_d = two.s_d;
      c.s_sun = two.s_s;
    } else {
      std::copy_n(&s_d[first], c.count, c.s_d.begin());
      fit_sun(c);
    }
    std::copy_n(c.s_d.begin(), c.count, &fit.s_d[first]);
    std::copy_n(c.s_sun.begin(), c.count, &fit.s_sun[first]);
    fit_fresnel(c, fit, n);
    fit_diffraction(c, fit, n);
    measure_residuals(c, fit, n);
    progress.update("spectra", double(std::min(first + B, n)), double(n));
  }
}

LobeWeights lobe_weights(const CellTable& table, const SplitResult& split) {
  LobeWeights lobes{.diffuse = std::vector<float>(table.fitted()),
                    .specular = std::vector<float>(table.fitted())};
  const double lambert = split.albedo_d / std::numbers::pi;
  for (std::size_t i = 0; i < table.fitted(); ++i) {
    const double w = double(table.weight[i]);
    const double shape = split.diffuse_shape.empty() ? 1.0 : double(split.diffuse_shape[table.cell[i]]);
    lobes.diffuse[i] = static_cast<float>(lambert * shape * w);
    lobes.specular[i] = static_cast<float>(double(split.rho_s[table.cell[i]]) / table.cos_sum(i) * w);
  }
  return lobes;
}

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
  if (n <= 4) {
    fit_blocks<4>(measured, table, lobes, s_d, options, progress, fit);
  } else {
    fit_blocks<16>(measured, table, lobes, s_d, options, progress, fit);
  }
  return fit;
}

}  // namespace spectrace
