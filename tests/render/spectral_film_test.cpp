// SPDX-License-Identifier: Apache-2.0
// Spectral images: unbiased in each bin, flat where the spectrum is, at one with the RGB image.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdint>
#include <numbers>
#include <vector>

#include "core/image/spectral_image.h"
#include "materials/dielectric.h"
#include "tests/support/render_scenes.h"

namespace spectrace::test {
namespace {

constexpr double kAlpha = 0.01;

struct SpectralRender {
  Image rgb, spectral;
};

SpectralRender render_bins(const SceneDesc& description, int spp, Layer layer = Layer::kBeauty,
                           std::uint64_t seed = 0) {
  SilentProgress progress;
  const Scene scene = build_scene(description, progress);
  RenderSession session(scene, {.spp = spp, .seed = seed});
  session.finish(progress);
  return {session.film().resolve(), session.film().resolve_spectral(layer)};
}

SceneDesc with_bins(SceneDesc scene, SpectralBins bins) {
  scene.range = bins.range;
  scene.film.spectral = SpectralFilmDesc{.bins = bins};
  return scene;
}

/// A grey ball inside a sky of 1: radiance 1/2 where it is seen, and nothing else is.
SceneDesc grey_furnace() {
  SceneDesc scene = empty_scene();
  scene.materials = {lambert("grey", Float(0.5))};
  scene.shapes = {sphere({0, 0, 0}, 1, "grey")};
  scene.camera.fov_deg = 5;
  scene.film = {32, 32};
  scene.lights = {sky(1)};
  return scene;
}

/// Mean and standard error of each bin over pixels, all of which see the same.
std::vector<Estimate> bin_estimates(const Image& spectral) {
  const std::size_t bins = spectral.channels.size() - 3,
                    pixels = spectral.data.size() / spectral.channels.size();
  std::vector<Estimate> estimates(bins);
  for (std::size_t b = 0; b < bins; ++b) {
    double sum = 0, squares = 0;
    for (std::size_t p = 0; p < pixels; ++p) {
      const double x = double(spectral.data[p * spectral.channels.size() + 3 + b]);
      sum += x;
      squares += x * x;
    }
    const double n = double(pixels), mean = sum / n;
    estimates[b] = {mean, std::sqrt((squares / n - mean * mean) / (n - 1))};
  }
  return estimates;
}

/// Largest |z| that normal noise stays below in all of `count` tests with probability 1 - kAlpha: Šidák,
/// and the normal tail inverted by bisection.
double sidak_limit(std::size_t count) {
  const double each = 1 - std::pow(1 - kAlpha, 1 / double(count));
  double low = 0, high = 10;
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (std::erfc(middle / std::numbers::sqrt2) > each ? low : high) = middle;
  }
  return low;
}

/// Amplitudes of the periods n, n / 2, n / 3, ... bins in a residual of n.
std::vector<std::complex<double>> periods_of(const std::vector<double>& residual) {
  const std::size_t n = residual.size();
  std::vector<std::complex<double>> amplitudes((n - 1) / 2);
  for (std::size_t k = 0; k < amplitudes.size(); ++k) {
    for (std::size_t i = 0; i < n; ++i) {
      amplitudes[k] +=
          residual[i] * std::polar(1.0, 2 * std::numbers::pi * double(k + 1) * double(i) / double(n));
    }
  }
  return amplitudes;
}

/// Fisher's g: the share of the strongest period in a residual. Its tail is below count (1 - g)^(count - 1).
double strongest_period_p(const std::vector<double>& residual) {
  double total = 0, most = 0;
  const auto amplitudes = periods_of(residual);
  for (const auto& amplitude : amplitudes) {
    total += std::norm(amplitude);
    most = std::max(most, std::norm(amplitude));
  }
  const auto count = double(amplitudes.size());
  return std::min(1.0, count * std::pow(1 - most / total, count - 1));
}

/// Of residuals of independent renders: how likely noise alone is to agree as well in the phase of any
/// period, by Šidák. A period that every render has keeps its phase. Noise has one at random: with complex
/// normal amplitudes |mean|² / mean |amplitude|² is Beta(1, renders - 1), whatever the power is at that
/// period. Stratified wavelengths leave noise between neighbours, and so no white one, as Fisher's g
/// supposes.
double common_period_p(const std::vector<std::vector<double>>& residuals) {
  const auto renders = double(residuals.size());
  std::vector<std::complex<double>> sums(periods_of(residuals[0]).size());
  std::vector<double> powers(sums.size());
  for (const auto& residual : residuals) {
    const auto amplitudes = periods_of(residual);
    for (std::size_t k = 0; k < sums.size(); ++k) {
      sums[k] += amplitudes[k];
      powers[k] += std::norm(amplitudes[k]);
    }
  }
  double least = 1;
  for (std::size_t k = 0; k < sums.size(); ++k) {
    least = std::min(least, std::pow(1 - std::norm(sums[k]) / (renders * powers[k]), renders - 1));
  }
  return 1 - std::pow(1 - least, double(sums.size()));
}

TEST(SpectralFilm, FlatSpectraStayFlatAndWithoutPeriod) {
  for (const bool at_centers : {false, true}) {
    const SpectralBins bins{.range = {360, 1000}, .count = 195, .at_centers = at_centers};
    const auto estimates = bin_estimates(render_bins(with_bins(grey_furnace(), bins), 32).spectral);
    ASSERT_EQ(estimates.size(), 195U);
    std::vector<double> residual;
    double worst = 0;
    for (const Estimate& e : estimates) {
      ASSERT_GT(e.standard_error, 0);
      residual.push_back((e.mean - 0.5) / e.standard_error);
      worst = std::max(worst, std::abs(residual.back()));
    }
    EXPECT_LT(worst, sidak_limit(estimates.size())) << "standard errors, at_centers " << at_centers;
    EXPECT_GT(strongest_period_p(residual), kAlpha) << "at_centers " << at_centers;
  }
}

TEST(SpectralFilm, RendersShareNoPeriod) {
  constexpr std::uint64_t kRenders = 12;
  const SceneDesc scene = with_bins(grey_furnace(), {.range = {360, 1000}, .count = 195});
  std::vector<std::vector<double>> residuals;
  std::vector<double> sums(195), variances(195);
  for (std::uint64_t seed = 1; seed <= kRenders; ++seed) {
    residuals.emplace_back();
    for (const Estimate& e : bin_estimates(render_bins(scene, 32, Layer::kBeauty, seed).spectral)) {
      const std::size_t b = residuals.back().size();
      residuals.back().push_back((e.mean - 0.5) / e.standard_error);
      sums[b] += e.mean - 0.5;
      variances[b] += e.standard_error * e.standard_error;
    }
  }
  EXPECT_GT(common_period_p(residuals), kAlpha);
  for (std::size_t b = 0; b < sums.size(); ++b) {
    EXPECT_LT(std::abs(sums[b]), sidak_limit(sums.size()) * std::sqrt(variances[b])) << b;
  }
  // It can fail: a period of eight bins of which each render alone says little.
  for (auto& residual : residuals) {
    for (std::size_t b = 0; b < residual.size(); ++b) {
      residual[b] += 0.4 * std::cos(2 * std::numbers::pi * double(b) / 8.125);  // 195 bins are 24 of them
    }
  }
  EXPECT_LT(common_period_p(residuals), kAlpha);
}

TEST(SpectralFilm, PeriodsAreFound) {
  // The test above can fail: noise with a period of an eighth of the range beside as much without.
  std::vector<double> residual;
  for (int i = 0; i < 195; ++i) {
    const double noise = std::sin(double(i * i) * 12.9898) * std::numbers::sqrt2;
    residual.push_back(noise + std::cos(2 * std::numbers::pi * i * 8 / 195.0));
  }
  EXPECT_LT(strongest_period_p(residual), kAlpha);
}

TEST(SpectralFilm, BinsHoldTheMeanOfWhatIsThere) {
  // A spectrum that bends within bins: the mean over a bin is not its centre's value.
  const Spectrum bent = TabulatedSpectrum({400, 449, 450, 451, 700}, {0, 0, 8, 0, 0});
  SceneDesc scene = empty_scene();
  scene.film = {32, 32};
  scene.lights = {EnvironmentDesc{.radiance = bent}};
  const SpectralBins bins{.range = {400, 700}, .count = 30};
  const auto means = bin_estimates(render_bins(with_bins(scene, bins), 64).spectral);
  // The triangle of area 8 lies half in the bin below 450 nm and half in the one above, each 10 nm wide.
  for (std::size_t b = 0; b < means.size(); ++b) {
    const double expected = b == 4 || b == 5 ? 0.4 : 0;
    EXPECT_NEAR(means[b].mean, expected, 4 * means[b].standard_error + 1e-9) << b;
  }
  const SpectralBins centers{.range = {400, 700}, .count = 30, .at_centers = true};
  for (const Estimate& e : bin_estimates(render_bins(with_bins(scene, centers), 64).spectral)) {
    EXPECT_EQ(e.mean, 0) << "no centre lies in the triangle";
  }
}

TEST(SpectralFilm, IntegratesToTheRgbImage) {
  SceneDesc scene = grey_furnace();
  scene.materials = {lambert(
      "grey", TabulatedSpectrum({400, 500, 600, 700}, {Float(0.1), Float(0.6), Float(0.3), Float(0.9)}))};
  const SpectralBins bins{.range = {360, 830}, .count = 195};
  const SpectralRender render = render_bins(with_bins(scene, bins), 64);
  Xyz from_bins{};
  const auto estimates = bin_estimates(render.spectral);
  for (std::size_t b = 0; b < bins.count; ++b) {
    // The observer over a bin: by tenths of it.
    for (int i = 0; i < 10; ++i) {
      const double nm = bins.center_nm(b) + bins.width_nm() * ((i + 0.5) / 10 - 0.5);
      const Xyz bar = cie_xyz_bar(nm);
      for (std::size_t c = 0; c < 3; ++c) {
        from_bins[c] += bar[c] * estimates[b].mean * bins.width_nm() / 10 / cie_y_integral();
      }
    }
  }
  const Rgb rgb = xyz_to_rgb(from_bins);
  for (std::size_t c = 0; c < 3; ++c) {
    double mean = 0, beside = 0;
    for (std::size_t p = 0; p < 32 * 32; ++p) {
      mean += double(render.rgb.data[p * render.rgb.channels.size() + c]) / (32 * 32);
      beside += double(render.spectral.data[p * render.spectral.channels.size() + c]) / (32 * 32);
    }
    EXPECT_NEAR(rgb[c], mean, 1e-3 * mean) << c;
    EXPECT_EQ(mean, beside);
  }
}

TEST(SpectralFilm, LobesSumToTheBeautyInEachBin) {
  SceneDesc scene = grey_furnace();
  Glossy glossy;
  glossy.reflectance = Texture(Spectrum(TabulatedSpectrum({400, 700}, {0, 1})));
  glossy.ggx = {Float(0.3), Float(0.3)};
  scene.materials = {{.name = "grey", .where = "/materials/0", .kind = glossy}};
  const SceneDesc with = with_bins(scene, {.range = {360, 1000}, .count = 64});
  const Image all = render_bins(with, 16).spectral, diffuse = render_bins(with, 16, Layer::kDiffuse).spectral,
              specular = render_bins(with, 16, Layer::kSpecular).spectral;
  double largest = 0;
  for (float x : all.data) largest = std::max(largest, double(x));
  for (std::size_t i = 0; i < all.data.size(); ++i) {
    ASSERT_NEAR(double(diffuse.data[i]) + double(specular.data[i]), double(all.data[i]), 1e-5 * largest);
  }
}

TEST(SpectralFilm, WavelengthsEndedByDispersionCountNowhere) {
  // A white sky through a dispersive, lossless ball is white: terminated lanes that were still counted would
  // darken it, heroes counted once too often would brighten it (H8).
  SceneDesc scene = empty_scene();
  scene.materials = {{.name = "glass",
                      .where = "/materials/0",
                      .kind = Dielectric{.eta = CauchySpectrum{.a = Float(1.5), .b_um2 = Float(0.02)}}}};
  scene.shapes = {sphere({0, 0, 0}, 1, "glass")};
  scene.camera.fov_deg = 5;
  scene.film = {32, 32};
  scene.integrator = {.max_depth = 64, .roulette_depth = 64};
  scene.lights = {sky(1)};
  const auto estimates =
      bin_estimates(render_bins(with_bins(scene, {.range = {360, 830}, .count = 20}), 64).spectral);
  for (const Estimate& e : estimates) {
    EXPECT_NEAR(e.mean, 1, sidak_limit(estimates.size()) * e.standard_error + 1e-4);
  }
}

TEST(SpectralFilm, ChannelsAreNamedAfterTheCentresOfBins) {
  const Image image = render_bins(with_bins(grey_furnace(), {.range = {400, 700}, .count = 3}), 1).spectral;
  EXPECT_EQ(image.channels, (std::vector<std::string>{"R", "G", "B", "S0.450,000000nm", "S0.550,000000nm",
                                                      "S0.650,000000nm"}));
}

}  // namespace
}  // namespace spectrace::test
