// SPDX-License-Identifier: Apache-2.0
#include "cli/compare/pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <system_error>
#include <utility>

#include "cli/report/exposure.h"
#include "core/base/error.h"
#include "core/image/error_map.h"

namespace spectrace::cli {

namespace {

// Of a signed map, which is linear around error_map.cpp's mid grey of 0.2: what it has below it.
constexpr double kSignedRange = 0.2;
// A few outliers must not leave the rest of a difference map grey.
constexpr double kGainPercentile = 0.99;

/// As R, G, B: colours and vectors as they are, of anything else the mean of the channels.
Image as_rgb(const Image& image, const ChannelGroup& group) {
  if (group.indices.size() == 3) {
    Image rgb = group_image(image, group);
    rgb.channels = {"R", "G", "B"};
    return rgb;
  }
  Image rgb(image.width, image.height, {"R", "G", "B"});
  const std::size_t n = image.channels.size();
  for (std::size_t pixel = 0; 3 * pixel < rgb.data.size(); ++pixel) {
    double sum = 0;
    for (const std::size_t c : group.indices) sum += double(image.data[pixel * n + c]);
    const auto mean = static_cast<float>(sum / double(group.indices.size()));
    std::fill_n(rgb.data.begin() + std::ptrdiff_t(3 * pixel), 3, mean);
  }
  return rgb;
}

Image exposed(Image rgb, double exposure) {
  for (float& x : rgb.data) x = static_cast<float>(double(x) * exposure);
  return rgb;
}

double gain_of(const Image& difference) {
  std::vector<float> magnitudes;
  for (const float x : difference.data) {
    if (std::isfinite(x) && x != 0) magnitudes.push_back(std::abs(x));
  }
  if (magnitudes.empty()) return 1;
  const auto place = magnitudes.begin() + std::ptrdiff_t(kGainPercentile * double(magnitudes.size() - 1));
  std::nth_element(magnitudes.begin(), place, magnitudes.end());
  return kSignedRange / double(*place);
}

Image z_picture(const ZTestResult& z) {
  ChannelGroup all{.name = "z", .channels = z.z.channels, .indices = {}};
  for (std::size_t c = 0; c < z.z.channels.size(); ++c) all.indices.push_back(c);
  return signed_map(as_rgb(z.z, all), kSignedRange / z.threshold);
}

}  // namespace

LayerPictures make_pictures(const NamedImage& reference, const NamedImage& test, const LayerResult& layer) {
  LayerPictures pictures;
  pictures.layer = layer.name();
  const Image r = as_rgb(reference.image, layer.reference), t = as_rgb(test.image, layer.test);
  Image difference = t;
  for (std::size_t i = 0; i < difference.data.size(); ++i) difference.data[i] -= r.data[i];
  pictures.gain = gain_of(difference);
  pictures.difference = signed_map(difference, pictures.gain);
  pictures.error =
      error_map(group_image(reference.image, layer.reference), group_image(test.image, layer.test));
  if (layer.z_test) pictures.z = z_picture(layer.z_test->result);
  pictures.exposure = exposure_of(r);
  pictures.reference = exposed(r, pictures.exposure);
  pictures.test = exposed(t, pictures.exposure);
  return pictures;
}

std::vector<std::filesystem::path> write_maps(const std::filesystem::path& folder, const std::string& prefix,
                                              const NamedImage& reference, const NamedImage& test,
                                              const Comparison& result) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error)
    throw InputError(folder.string(), "", fmt::format("cannot make the folder: {}", error.message()));
  std::vector<std::filesystem::path> files;
  const auto write = [&](const std::string& layer, const char* kind, const Image& picture) {
    std::string name = layer;
    std::replace(name.begin(), name.end(), '/', '_');  // channels may be called anything
    files.push_back(folder / fmt::format("{}{}-{}.png", prefix, name, kind));
    write_png(files.back(), picture);
  };
  for (const LayerResult& layer : result.layers) {
    const LayerPictures pictures = make_pictures(reference, test, layer);
    write(layer.name(), "difference", pictures.difference);
    write(layer.name(), "error", pictures.error);
    if (pictures.z) write(layer.name(), "z", *pictures.z);
  }
  return files;
}

}  // namespace spectrace::cli
