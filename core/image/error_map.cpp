// SPDX-License-Identifier: Apache-2.0
#include "core/image/error_map.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/error.h"

namespace spectrace {
namespace {

// Linear sRGB, of rising luminance, so that the map reads in print and to the colour-blind.
constexpr std::array<std::array<float, 3>, 5> kRamp{{{0.00F, 0.00F, 0.00F},
                                                     {0.06F, 0.01F, 0.18F},
                                                     {0.45F, 0.03F, 0.12F},
                                                     {0.95F, 0.32F, 0.02F},
                                                     {1.00F, 0.95F, 0.65F}}};
constexpr float kMidGrey = 0.2F;  // linear: half way up the sRGB curve

/// `x` in [0, 1].
std::array<float, 3> ramp_colour(double x) {
  const double place = x * double(kRamp.size() - 1);
  const std::size_t lower = std::min(static_cast<std::size_t>(place), kRamp.size() - 2);
  const auto fraction = static_cast<float>(place - double(lower));
  std::array<float, 3> colour{};
  for (std::size_t c = 0; c < 3; ++c) {
    colour[c] = kRamp[lower][c] + fraction * (kRamp[lower + 1][c] - kRamp[lower][c]);
  }
  return colour;
}

}  // namespace

Image error_map(const Image& reference, const Image& test, double full, double floor) {
  SPECTRACE_CHECK(reference.width == test.width && reference.height == test.height &&
                  reference.channels.size() == test.channels.size() && full > 0 && floor > 0);
  Image map(reference.width, reference.height, {"R", "G", "B"});
  const std::size_t n = reference.channels.size();
  for (std::size_t pixel = 0; pixel < map.data.size() / 3; ++pixel) {
    double error = 0;
    for (std::size_t c = pixel * n; c < (pixel + 1) * n; ++c) {
      const double r = double(reference.data[c]);
      error += std::abs(double(test.data[c]) - r) / (std::abs(r) + floor);
    }
    error /= double(n);
    // Not finite: full error, whatever it is.
    const auto colour = ramp_colour(error < full ? error / full : 1.0);
    std::copy(colour.begin(), colour.end(), map.data.begin() + std::ptrdiff_t(3 * pixel));
  }
  return map;
}

Image error_scale(int width, int height) {
  Image scale(width, height, {"R", "G", "B"});
  const int margin = width / 10, top = height * 2 / 5, bottom = height * 3 / 5;
  for (int y = top; y < bottom; ++y) {
    for (int x = margin; x < width - margin; ++x) {
      const auto colour = ramp_colour(double(x - margin) / double(std::max(1, width - 2 * margin - 1)));
      std::copy(colour.begin(), colour.end(), &scale.at(x, y, 0));
    }
  }
  return scale;
}

Image signed_map(const Image& rgb, double gain) {
  Image map = rgb;
  for (float& x : map.data) x = kMidGrey + static_cast<float>(gain) * x;
  return map;
}

}  // namespace spectrace
