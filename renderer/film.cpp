// SPDX-License-Identifier: Apache-2.0
#include "renderer/film.h"

namespace spectrace {

Film::Film(int width, int height, LayerSet layers)
    : width_(width),
      height_(height),
      layers_(static_cast<std::size_t>(layers)),
      sums_(std::size_t(width) * height * layers_),
      counts_(std::size_t(width) * height) {}

void Film::add(int x, int y, const PixelSums& sums) {
  const std::size_t pixel = std::size_t(y) * width_ + x;
  counts_[pixel].valid += sums.valid;
  counts_[pixel].invalid += sums.invalid;
  for (std::size_t layer = 0; layer < layers_; ++layer) {
    for (std::size_t c = 0; c < 3; ++c) sums_[pixel * layers_ + layer][c] += sums.xyz[layer][c];
  }
}

Image Film::resolve() const {
  // In the order of Layer.
  constexpr std::array<const char*, kLayerCount> kPrefixes{"",
                                                           "diffuse.",
                                                           "specular.",
                                                           "emission.",
                                                           "background.",
                                                           "specular_fresnel.",
                                                           "specular_diffraction.",
                                                           "specular_residual."};
  std::vector<std::string> names;
  for (std::size_t layer = 0; layer < layers_; ++layer) {
    for (const char* channel : {"R", "G", "B"}) {
      names.push_back(std::string(kPrefixes[layer]) + channel);
    }
  }
  names.emplace_back("diagnostics.invalid");
  Image image(width_, height_, std::move(names));
  float* out = image.data.data();
  const Xyz* sum = sums_.data();
  for (const Counts& counts : counts_) {
    const double scale = counts.valid > 0 ? 1 / double(counts.valid) : 0;
    for (std::size_t layer = 0; layer < layers_; ++layer, ++sum) {
      for (double channel : xyz_to_rgb({(*sum)[0] * scale, (*sum)[1] * scale, (*sum)[2] * scale})) {
        *out++ = float(channel);
      }
    }
    *out++ = float(counts.invalid);
  }
  return image;
}

std::uint64_t Film::invalid_samples() const {
  std::uint64_t total = 0;
  for (const Counts& counts : counts_) total += counts.invalid;
  return total;
}

}  // namespace spectrace
