// SPDX-License-Identifier: Apache-2.0
// The images that a film's sums make.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>

#include "core/base/error.h"
#include "core/image/metrics.h"
#include "core/image/spectral_image.h"
#include "core/spectra/color.h"
#include "renderer/film.h"

namespace spectrace {

namespace {

constexpr std::array<const char*, 3> kRgb{"R", "G", "B"}, kXyzNames{"X", "Y", "Z"};

double over(double sum, double count) { return count > 0 ? sum / count : 0; }

/// What a channel holds of a number beyond its range: the largest that there is, and no infinity. Squares of
/// 1e20 are among those (hard case H18).
float to_channel(double value) {
  constexpr double kLargest = std::numeric_limits<float>::max();
  return static_cast<float>(std::clamp(value, -kLargest, kLargest));
}

Rgb mean_rgb(const Xyz& sum, double count) {
  return xyz_to_rgb({over(sum[0], count), over(sum[1], count), over(sum[2], count)});
}

/// Of the mean: Σ(x - x̄)² / (n (n - 1)); 0 where one sample tells nothing of it.
double variance_of_mean(double sum, double sum_of_squares, double n) {
  if (n < 2) return 0;
  return std::max(0.0, sum_of_squares - sum * sum / n) / (n * (n - 1));
}

/// A channel's name in its pieces: put together only where it is asked for, not at every pixel.
struct ChannelName {
  std::string_view layer, suffix, channel;

  [[nodiscard]] std::string text() const {
    std::string text;
    for (const std::string_view piece : {layer, suffix}) text += piece;
    if (!text.empty()) text += '.';
    return text += channel;
  }
};

Rgb rgb_of_half_a(const PixelTotal& total, std::size_t moment) {
  Xyz a = total.three(slots::xyz(Layer(moment)));
  const Xyz b = total.three(slots::b_xyz(moment));
  for (std::size_t c = 0; c < 3; ++c) a[c] -= b[c];
  return mean_rgb(a, total.valid - total.valid_b);
}
Rgb rgb_of_half_b(const PixelTotal& total, std::size_t moment) {
  return mean_rgb(total.three(slots::b_xyz(moment)), total.valid_b);
}
Rgb rgb_of(const PixelTotal& total, Layer layer) {
  return mean_rgb(total.three(slots::xyz(layer)), total.valid);
}

/// Names the channels of a pixel, or fills them: the same walk for both, so that they cannot part.
class ChannelWalk {
 public:
  ChannelWalk(const FilmLayout& layout, std::vector<std::string>& names) : layout_(layout), names_(&names) {}
  ChannelWalk(const FilmLayout& layout, const PixelTotal& total, float* out)
      : layout_(layout), total_(&total), out_(out) {}

  void walk() {
    layout_.layers.for_each([&](Layer layer) { add_layer(layer); });
    if (layout_.aovs.xyz) add_xyz();
    if (layout_.aovs.direct) add_indirect();
    const std::size_t moments = layout_.aovs.lobes ? kMomentLayers : 1;
    for (std::size_t m = 0; m < moments; ++m) add_moments(m);
    for (const Feature feature : kFeatureList) {
      if (layout_.aovs.has(feature)) add_feature(feature);
    }
    const AovSet& aovs = layout_.aovs;
    if (aovs.samples) add({"samples", "", "Z"}, [&] { return total_->valid; });
    add({"diagnostics", "", "invalid"}, [&] { return total_->v[slots::kInvalid]; });
    if (aovs.extrapolated) {
      add({"diagnostics", "", "extrapolated"}, [&] { return total_->v[slots::kExtrapolated]; });
    }
  }

 private:
  template <typename Value>
  void add(const ChannelName& name, const Value& value) {
    if (names_ != nullptr) {
      names_->push_back(name.text());
    } else {
      *out_++ = to_channel(double(value()));
    }
  }
  template <typename Value>
  void add_rgb(std::string_view layer, std::string_view suffix, const Value& value) {
    const Rgb rgb = names_ != nullptr ? Rgb{} : value();
    for (std::size_t c = 0; c < 3; ++c) add({layer, suffix, kRgb[c]}, [&] { return rgb[c]; });
  }

  void add_layer(Layer layer) {
    add_rgb(layer_name(layer), "", [&] { return rgb_of(*total_, layer); });
  }
  void add_xyz() {
    for (std::size_t c = 0; c < 3; ++c) {
      add({"xyz", "", kXyzNames[c]},
          [&] { return over(total_->v[slots::xyz(Layer::kBeauty) + c], total_->valid); });
    }
  }
  /// What is not direct.
  void add_indirect() {
    const auto rest = [&](Layer all, Layer direct) {
      return [&, all, direct] {
        Xyz sum = total_->three(slots::xyz(all));
        const Xyz of_it = total_->three(slots::xyz(direct));
        for (std::size_t c = 0; c < 3; ++c) sum[c] -= of_it[c];
        return mean_rgb(sum, total_->valid);
      };
    };
    add_rgb("diffuse_indirect", "", rest(Layer::kDiffuse, Layer::kDiffuseDirect));
    add_rgb("specular_indirect", "", rest(Layer::kSpecular, Layer::kSpecularDirect));
  }
  void add_moments(std::size_t m) {
    const auto layer = Layer(m);
    const std::string_view name = layer == Layer::kBeauty ? "beauty" : layer_name(layer);
    if (layout_.aovs.halves) {
      add_rgb(name, "_a", [&] { return rgb_of_half_a(*total_, m); });
      add_rgb(name, "_b", [&] { return rgb_of_half_b(*total_, m); });
    }
    if (layout_.aovs.variance) {
      add_rgb(name, "_variance", [&] {
        const Rgb sum = xyz_to_rgb(total_->three(slots::xyz(layer)));
        Rgb variance{};
        for (std::size_t c = 0; c < 3; ++c) {
          variance[c] = variance_of_mean(sum[c], total_->v[slots::rgb_squares(m) + c], total_->valid);
        }
        return variance;
      });
    }
  }
  void add_feature(Feature feature) {
    const bool is_color = feature <= Feature::kAlbedo;
    const std::size_t begin = feature_begin(feature);
    const auto channels = [&](std::string_view suffix, const auto& value) {
      for (std::size_t c = 0; c < feature_size(feature); ++c) {
        const char* const channel = is_color ? kRgb[c] : feature == Feature::kDepth ? "Z" : kXyzNames[c];
        add({feature_name(feature), suffix, channel}, [&] { return value(c); });
      }
    };
    channels("", [&](std::size_t c) { return over(total_->v[slots::kFeatures + begin + c], total_->valid); });
    if (!layout_.aovs.feature_variance) return;
    channels("_variance", [&](std::size_t c) {
      return variance_of_mean(total_->v[slots::kFeatures + begin + c],
                              total_->v[slots::kFeatureSquares + begin + c], total_->valid);
    });
  }

  const FilmLayout& layout_;
  std::vector<std::string>* names_ = nullptr;
  const PixelTotal* total_ = nullptr;
  float* out_ = nullptr;
};

}  // namespace

template <typename Visit>
void Film::for_each_total(const Visit& visit) const {
  for (std::size_t tile = 0; tile < tiles_.size(); ++tile) {
    const std::size_t count = blocks(tile).size();
    const double taken = double(samples(tile)), taken_b = double(samples_in_half_b(tile));
    for_each_pixel(tiles_[tile], [&](std::size_t pixel) {
      PixelTotal total;
      for (std::size_t i = 0; i < slots_.size(); ++i) {
        double& sum = total.v[slots_[i]];
        for (std::size_t b = 0; b < count; ++b) sum += planes_[b].rows[pixel * slots_.size() + i];
      }
      total.valid = taken - total.v[slots::kInvalid];
      total.valid_b = taken_b - total.v[slots::kInvalidB];
      visit(pixel, total);
    });
  }
}

std::uint64_t Film::memory_bytes(int width, int height, const FilmLayout& layout, SampleRange target) {
  std::vector<std::string> names;
  ChannelWalk(layout, names).walk();
  std::size_t channels = names.size();
  for (const Matte matte : kMattes) {
    if (has_matte(layout.aovs, matte)) channels += matte_channels(matte).size();
  }
  if (layout.bins) channels = std::max(channels, layout.bins->count + kRgb.size());
  const std::size_t plane =
      layout.kept_slots().size() * sizeof(double) + layout.bins_per_pixel() * sizeof(float);
  // An image, and the bytes of its file: noise does not compress.
  const std::size_t image = 2 * channels * sizeof(float);
  return std::uint64_t(width) * std::uint64_t(height) * (blocks_of(target.leaves()).size() * plane + image);
}

Image Film::resolve() const {
  std::vector<std::string> names;
  ChannelWalk(layout_, names).walk();
  std::array<std::size_t, kMatteKinds> first_channels{};
  for (const Matte matte : kMattes) {
    first_channels[std::size_t(matte)] = names.size();
    if (!has_matte(layout_.aovs, matte)) continue;
    for (std::string& name : matte_channels(matte)) names.push_back(std::move(name));
  }
  Image image(width_, height_, std::move(names));
  std::vector<double> valid(layout_.aovs.any_matte() ? std::size_t(width_) * std::size_t(height_) : 0);
  for_each_total([&](std::size_t pixel, const PixelTotal& total) {
    ChannelWalk(layout_, total, &image.data[pixel * image.channels.size()]).walk();
    if (!valid.empty()) valid[pixel] = total.valid;
  });
  for (const Matte matte : kMattes) {
    if (has_matte(layout_.aovs, matte))
      resolve_matte(matte, valid, first_channels[std::size_t(matte)], image);
  }
  return image;
}

double Film::relative_error() const {
  SPECTRACE_CHECK(layout_.aovs.halves);
  const double numbers = 3.0 * double(width_) * double(height_);
  double sum = 0;
  for_each_total([&](std::size_t, const PixelTotal& total) {
    for (const double mean : rgb_of(total, Layer::kBeauty)) sum += mean;
  });
  const double image_mean = sum / numbers, epsilon = kRelativeEpsilon * image_mean * image_mean;
  double squares = 0;
  bool is_known = false;
  for_each_total([&](std::size_t, const PixelTotal& total) {
    if (!(total.valid_b > 0 && total.valid > total.valid_b)) return;
    is_known = true;
    const auto moment = std::size_t(Layer::kBeauty);
    const Rgb mean = rgb_of(total, Layer::kBeauty);
    const Rgb a = rgb_of_half_a(total, moment), b = rgb_of_half_b(total, moment);
    // Of halves of na and nb samples: (a - b)² has 1 / na + 1 / nb of a sample's variance, their mean 1 / (na
    // + nb).
    const double scale = std::sqrt((total.valid - total.valid_b) * total.valid_b) / total.valid;
    for (std::size_t c = 0; c < 3; ++c) {
      const double d = (a[c] - b[c]) * scale;
      if (d != 0) squares += d * d / (mean[c] * mean[c] + epsilon);
    }
  });
  return is_known ? std::sqrt(squares / numbers) : std::numeric_limits<double>::infinity();
}

Image Film::resolve_spectral(Layer layer) const {
  SPECTRACE_CHECK(layout_.bins && layout_.bin_layers.has(layer) && layout_.layers.has(layer));
  const SpectralBins& bins = *layout_.bins;
  std::vector<std::string> names(kRgb.begin(), kRgb.end());
  for (const double nm : bins.centers_nm())
    names.push_back(spectral_channel_name(SpectralKind::kRadiance, nm));
  Image image(width_, height_, std::move(names));
  const std::size_t stride = layout_.bins_per_pixel(), offset = layout_.bin_layers.slot(layer) * bins.count;
  const auto kept = std::find(slots_.begin(), slots_.end(), slots::xyz(layer));
  const auto slot = std::size_t(kept - slots_.begin());
  for (std::size_t tile = 0; tile < tiles_.size(); ++tile) {
    const std::size_t count = blocks(tile).size();
    for_each_pixel(tiles_[tile], [&](std::size_t pixel) {
      const auto sum = [&](const auto& of_plane) {
        double total = 0;
        for (std::size_t b = 0; b < count; ++b) total += double(of_plane(planes_[b]));
        return total;
      };
      const auto row = [&](std::size_t i) {
        return sum([&](const Plane& plane) { return plane.rows[pixel * slots_.size() + i]; });
      };
      const double valid = double(samples(tile)) - row(0);
      float* out = &image.data[pixel * image.channels.size()];
      for (double channel : mean_rgb({row(slot), row(slot + 1), row(slot + 2)}, valid))
        *out++ = to_channel(channel);
      for (std::size_t bin = 0; bin < bins.count; ++bin) {
        const double total =
            sum([&](const Plane& plane) { return plane.bins[pixel * stride + offset + bin]; });
        *out++ = to_channel(over(total, valid));
      }
    });
  }
  return image;
}

}  // namespace spectrace
