// SPDX-License-Identifier: Apache-2.0
#include "renderer/environment.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "core/base/error.h"
#include "core/math/math.h"
#include "core/spectra/color.h"

namespace spectrace {

namespace {

/// Index of the cell of `cumulative` (n + 1 entries from 0 to 1) that holds u, never an empty one.
int find_cell(const float* cumulative, int n, Float u) {
  const auto* above = std::upper_bound(cumulative, cumulative + n + 1, float(u));
  int cell = std::clamp(int(above - cumulative) - 1, 0, n - 1);
  while (cell > 0 && cumulative[cell + 1] <= cumulative[cell]) {
    --cell;  // u = 1 lands behind trailing empty cells
  }
  return cell;
}

void accumulate(const double* weights, std::size_t n, float* cumulative) {
  double total = 0;
  for (std::size_t i = 0; i < n; ++i) {
    total += weights[i];
  }
  double sum = 0;
  cumulative[0] = 0;
  for (std::size_t i = 0; i < n; ++i) {
    sum += total > 0 ? weights[i] / total : 1.0 / double(n);
    cumulative[i + 1] = float(std::min(sum, 1.0));
  }
  cumulative[n] = 1;
}

}  // namespace

GridDensity::GridDensity(int width, int height, const std::vector<double>& weights)
    : width_(width),
      height_(height),
      rows_(std::size_t(height) + 1),
      cells_(std::size_t(height) * (width + 1)) {
  SPECTRACE_CHECK(width > 0 && height > 0 && weights.size() == std::size_t(width) * height);
  std::vector<double> row_sums(height);
  for (int y = 0; y < height; ++y) {
    const double* row = &weights[std::size_t(y) * width];
    for (int x = 0; x < width; ++x) {
      SPECTRACE_CHECK(row[x] >= 0 && std::isfinite(row[x]));
      row_sums[y] += row[x];
    }
    accumulate(row, width, &cells_[std::size_t(y) * (width + 1)]);
  }
  accumulate(row_sums.data(), height, rows_.data());
}

GridDensity::Sample GridDensity::sample(Vec2 u) const {
  const int y = find_cell(rows_.data(), height_, u.y);
  const float* row = &cells_[std::size_t(y) * (width_ + 1)];
  const int x = find_cell(row, width_, u.x);
  const Float row_share = rows_[y + 1] - rows_[y], cell_share = row[x + 1] - row[x];
  const Float fy = std::clamp((u.y - rows_[y]) / row_share, Float(0), kOneMinusEpsilon);
  const Float fx = std::clamp((u.x - row[x]) / cell_share, Float(0), kOneMinusEpsilon);
  return {{(Float(x) + fx) / Float(width_), (Float(y) + fy) / Float(height_)},
          row_share * cell_share * Float(width_) * Float(height_)};
}

Float GridDensity::pdf(Vec2 position) const {
  const int x = std::clamp(int(position.x * Float(width_)), 0, width_ - 1);
  const int y = std::clamp(int(position.y * Float(height_)), 0, height_ - 1);
  const float* row = &cells_[std::size_t(y) * (width_ + 1)];
  return Float(rows_[y + 1] - rows_[y]) * Float(row[x + 1] - row[x]) * Float(width_) * Float(height_);
}

namespace {

/// D65 as uplifted emission carries it: S(0) = 1/2 at every wavelength, scale 2.
Float white_at(Float lambda_nm) {
  return RgbIlluminantSpectrum{SigmoidSpectrum{.c = {0, 0, 0}, .scale = 2}}.at(lambda_nm);
}

Vec2 image_position(Vec3 local) {
  return {Float(0.5) - std::atan2(local.y, local.x) * (kInvPi / 2), safe_acos(local.z) * kInvPi};
}

/// Mean weights along one axis of the texels before, at and after a cell's own, where `parts` cells divide a
/// texel: ∫ of their tent functions over the cell.
std::array<double, 3> tent_weights(int parts, int part) {
  if (parts == 1) {
    return {0.125, 0.75, 0.125};
  }
  return part == 0 ? std::array{0.25, 0.75, 0.0} : std::array{0.0, 0.75, 0.25};
}

/// The bilinear image's integral over each cell (parts x parts of them a texel), times the cell's sinθ.
std::vector<double> cell_weights(const std::vector<double>& luminance, int width, int height, int parts) {
  std::vector<double> weights;
  weights.reserve(luminance.size() * parts * parts);
  for (int cell_y = 0; cell_y < height * parts; ++cell_y) {
    const double sin_theta = std::sin(double(kPi) * (cell_y + 0.5) / (height * parts));
    const auto along_y = tent_weights(parts, cell_y % parts);
    for (int cell_x = 0; cell_x < width * parts; ++cell_x) {
      const auto along_x = tent_weights(parts, cell_x % parts);
      double sum = 0;
      for (int dy = -1; dy <= 1; ++dy) {
        const int row = std::clamp(cell_y / parts + dy, 0, height - 1);
        for (int dx = -1; dx <= 1; ++dx) {
          const int column = (cell_x / parts + dx + width) % width;
          sum += along_y[dy + 1] * along_x[dx + 1] * luminance[std::size_t(row) * width + column];
        }
      }
      weights.push_back(sum * sin_theta);
    }
  }
  return weights;
}

void check_radiance(double value, int x, int y, const std::string& file) {
  if (!std::isfinite(value) || value < 0) {
    throw InputError(file, fmt::format("pixel ({}, {})", x, y),
                     fmt::format("radiance must be finite and not negative, got {}", value));
  }
}

/// Luminance of a spectrum, linear between `lambda_nm`, is the sum of its values times these.
std::vector<double> luminance_weights(const std::vector<Float>& lambda_nm) {
  std::vector<double> weights(lambda_nm.size());
  std::vector<Float> one(lambda_nm.size());
  for (std::size_t i = 0; i < lambda_nm.size(); ++i) {
    one[i] = 1;
    weights[i] = spectrum_to_xyz(Spectrum(TabulatedSpectrum(lambda_nm, one)))[1];
    one[i] = 0;
  }
  return weights;
}

}  // namespace

std::vector<double> Environment::take_rgb(const Image& image, const std::string& file) {
  const std::vector<std::string> rgb_names{"R", "G", "B"};
  const Image rgb = image.select(rgb_names, file);
  texels_.reserve(std::size_t(width_) * height_);
  std::vector<double> luminance;
  luminance.reserve(texels_.capacity());
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      const Rgb value{rgb.at(x, y, 0), rgb.at(x, y, 1), rgb.at(x, y, 2)};
      for (double channel : value) check_radiance(channel, x, y, file);
      texels_.push_back(uplift_emission_fast(value).sigmoid);
      luminance.push_back(rgb_to_xyz(value)[1]);
    }
  }
  return luminance;
}

std::vector<double> Environment::take_spectra(SpectralImage spectra, const std::string& file) {
  spectra_ = std::move(spectra);
  const std::size_t nodes = spectra_->lambda_nm().size();
  const std::vector<double> weights = luminance_weights(spectra_->lambda_nm());
  std::vector<double> luminance, mean(nodes);
  luminance.reserve(std::size_t(width_) * height_);
  double sin_sum = 0;
  for (int y = 0; y < height_; ++y) {
    const double sin_theta = std::sin(double(kPi) * (y + 0.5) / height_);
    sin_sum += sin_theta * width_;
    for (int x = 0; x < width_; ++x) {
      const float* const values = &spectra_->values()[luminance.size() * nodes];
      double sum = 0;
      for (std::size_t i = 0; i < nodes; ++i) {
        check_radiance(values[i], x, y, file);
        sum += weights[i] * values[i];
        mean[i] += sin_theta * values[i];
      }
      luminance.push_back(sum);
    }
  }
  std::vector<Float> mean_values;
  for (double sum : mean) mean_values.push_back(Float(sum / sin_sum));
  mean_spectrum_.emplace(spectra_->lambda_nm(), std::move(mean_values));
  return luminance;
}

Environment::Environment(Spectrum radiance) : radiance_(std::move(radiance)) {}

Environment::Environment(const Image& image, const std::filesystem::path& file, Spectrum radiance,
                         const Transform& to_world)
    : radiance_(std::move(radiance)), width_(image.width), height_(image.height) {
  if (width_ < 1 || height_ < 1) {
    throw InputError(file.string(), "", "is an empty image");
  }
  axes_ = {normalize(to_world.vector({1, 0, 0})), normalize(to_world.vector({0, 1, 0})),
           normalize(to_world.vector({0, 0, 1}))};
  std::optional<SpectralImage> spectra = spectral_channels(image, SpectralKind::kRadiance, file.string());
  const std::vector<double> luminance =
      spectra ? take_spectra(std::move(*spectra), file.string()) : take_rgb(image, file.string());
  // Quarters of texels follow the bilinear image closely: what shines beside a bright texel is at most 4
  // times what its density promises, against 16 times with whole texels. Beyond 8 million texels that is too
  // much memory.
  constexpr std::size_t kMostTexelsToDivide = std::size_t(1) << 23U;
  const int parts = luminance.size() <= kMostTexelsToDivide ? 2 : 1;
  std::vector<double> weights = cell_weights(luminance, width_, height_, parts);
  std::vector<double> sines;
  for (int y = 0; y < height_ * parts; ++y) {
    sines.push_back(std::sin(kPi64 * (y + 0.5) / (height_ * parts)));
  }
  const double all = std::accumulate(weights.begin(), weights.end(), 0.0);
  mean_luminance_ = all / (std::accumulate(sines.begin(), sines.end(), 0.0) * width_ * parts);
  // Only what is brighter than the mean is worth light samples: the rest is found by BSDF sampling at least
  // as well, and multiple importance sampling joins the two (Karlík et al. 2019, "MIS Compensation", sec. 4).
  for (std::size_t i = 0; i < weights.size(); ++i) {
    weights[i] = std::max(0.0, weights[i] - mean_luminance_ * sines[i / (std::size_t(width_) * parts)]);
  }
  sampled_share_ = all > 0 ? std::accumulate(weights.begin(), weights.end(), 0.0) / all : 0;
  density_ = GridDensity(width_ * parts, height_ * parts, weights);
}

SampledSpectrum Environment::radiance(Vec3 direction, const SampledWavelengths& lambda) const {
  SampledSpectrum result = radiance_.sample(lambda);
  if (!is_image()) {
    return result;
  }
  const Vec2 position = image_position(axes_.to_local(direction));
  const Float px = position.x * Float(width_) - Float(0.5), py = position.y * Float(height_) - Float(0.5);
  const int x0 = int(std::floor(px)), y0 = int(std::floor(py));
  const Float fx = px - Float(x0), fy = py - Float(y0);
  const int xa = (x0 + width_) % width_, xb = (x0 + 1 + width_) % width_;
  const int ya = std::clamp(y0, 0, height_ - 1), yb = std::clamp(y0 + 1, 0, height_ - 1);
  const auto texel = [&](int x, int y) { return std::size_t(y) * std::size_t(width_) + std::size_t(x); };
  const std::size_t t00 = texel(xa, ya), t10 = texel(xb, ya), t01 = texel(xa, yb), t11 = texel(xb, yb);
  const auto bilinear = [&](const auto& at) {
    return lerp(lerp(at(t00), at(t10), fx), lerp(at(t01), at(t11), fx), fy);
  };
  for (int lane = 0; lane < kLanes; ++lane) {
    const Float nm = lambda.lambda_nm(lane);
    if (spectra_) {
      const SpectralPlace place = spectra_->place(nm);
      result[lane] *= bilinear([&](std::size_t t) { return spectra_->at(t, place); });
    } else {
      result[lane] *= bilinear([&](std::size_t t) { return texels_[t].at(nm); }) * white_at(nm);
    }
  }
  return result;
}

std::optional<Environment::Sample> Environment::sample(Vec2 u) const {
  if (!(sampled_share_ > 0)) return std::nullopt;
  const GridDensity::Sample s = density_.sample(u);
  const Float theta = s.position.y * kPi, phi = (Float(0.5) - s.position.x) * (2 * kPi);
  const Float sin_theta = std::sin(theta);
  // dω = 2π² sinθ du dv.
  const Float pdf = s.pdf / (2 * kPi * kPi * sin_theta);
  if (!(sin_theta > 0) || !(pdf > 0) || !std::isfinite(pdf)) {
    return std::nullopt;
  }
  return Sample{axes_.to_world({sin_theta * std::cos(phi), sin_theta * std::sin(phi), std::cos(theta)}), pdf};
}

Float Environment::pdf(Vec3 direction) const {
  if (!(sampled_share_ > 0)) return 0;
  const Vec3 local = axes_.to_local(direction);
  const Float sin_theta = std::sqrt(sqr(local.x) + sqr(local.y));
  const Float pdf = density_.pdf(image_position(local)) / (2 * kPi * kPi * sin_theta);
  return sin_theta > 0 && std::isfinite(pdf) ? pdf : 0;
}

Float Environment::mean_radiance(Float lambda_nm) const {
  if (mean_spectrum_) return radiance_.at(lambda_nm) * mean_spectrum_->at(lambda_nm);
  return radiance_.at(lambda_nm) * Float(mean_luminance_) * (is_image() ? white_at(lambda_nm) : 1);
}

}  // namespace spectrace
