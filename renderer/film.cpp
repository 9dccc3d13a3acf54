// SPDX-License-Identifier: Apache-2.0
#include "renderer/film.h"

namespace spectrace {

Film::Film(int width, int height) : width_(width), height_(height), pixels_(std::size_t(width) * height) {}

void Film::add(int x, int y, const PathValue& value) {
  Pixel& pixel = pixels_[std::size_t(y) * width_ + x];
  pixel.measured += value.measured;
  pixel.extrapolated += value.extrapolated;
  if (!value.valid) {
    ++pixel.invalid;
    return;
  }
  ++pixel.valid;
  for (int layer = 0; layer < kLayerCount; ++layer) {
    for (int c = 0; c < 3; ++c) {
      pixel.sum[layer][c] += value.xyz[layer][c];
    }
  }
}

Image Film::resolve(LayerSet layers) const {
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
  for (int layer = 0; layer < int(layers); ++layer) {
    for (const char* channel : {"R", "G", "B"}) {
      names.push_back(std::string(kPrefixes[layer]) + channel);
    }
  }
  names.emplace_back("diagnostics.invalid");
  Image image(width_, height_, std::move(names));
  float* out = image.data.data();
  for (const Pixel& pixel : pixels_) {
    const double scale = pixel.valid > 0 ? 1 / double(pixel.valid) : 0;
    for (int layer = 0; layer < int(layers); ++layer) {
      const Xyz& sum = pixel.sum[layer];
      for (double channel : xyz_to_rgb({sum[0] * scale, sum[1] * scale, sum[2] * scale})) {
        *out++ = float(channel);
      }
    }
    *out++ = float(pixel.invalid);
  }
  return image;
}

std::uint64_t Film::invalid_samples() const {
  std::uint64_t total = 0;
  for (const Pixel& pixel : pixels_) {
    total += pixel.invalid;
  }
  return total;
}

double Film::extrapolated_share() const {
  std::uint64_t measured = 0, extrapolated = 0;
  for (const Pixel& pixel : pixels_) {
    measured += pixel.measured;
    extrapolated += pixel.extrapolated;
  }
  return measured > 0 ? double(extrapolated) / double(measured) : 0;
}

}  // namespace spectrace
