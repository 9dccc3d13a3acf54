// SPDX-License-Identifier: Apache-2.0
#include "core/image/texels.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/image/area_means.h"
#include "core/image/kept_levels.h"

namespace spectrace {

std::vector<TexelLevel> halved_levels(int width, int height) {
  std::vector<TexelLevel> levels{{.width = width, .height = height}};
  while (width > 1 || height > 1) {
    width = std::max(width / 2, 1);
    height = std::max(height / 2, 1);
    levels.push_back({.width = width, .height = height});
  }
  return levels;
}

KeptLevels::KeptLevels(const std::vector<TexelLevel>& levels, std::size_t first, std::size_t channels,
                       std::vector<std::vector<float>> finest)
    : first_(first), texels_(std::move(finest)) {
  for (std::size_t i = first + texels_.size(); i < levels.size(); ++i) {
    const TexelLevel &fine = levels[i - 1], &coarse = levels[i];
    AreaMeans means({fine.width, fine.height}, {coarse.width, coarse.height}, 0, coarse.height, channels);
    for (int y = 0; y < fine.height; ++y) {
      means.add(y, &texels_.back()[std::size_t(y) * std::size_t(fine.width) * channels]);
    }
    texels_.push_back(means.means());
  }
}

std::vector<float> KeptLevels::rows(std::size_t level, int y0, int y1, std::size_t row_size) const {
  const auto begin = texels_[level - first_].begin();
  return {begin + std::ptrdiff_t(std::size_t(y0) * row_size),
          begin + std::ptrdiff_t(std::size_t(y1) * row_size)};
}

float usable_texel(float x) { return x > 0 ? std::min(x, 1.0f) : 0.0f; }

namespace {

class MemoryReader final : public TexelReader {
 public:
  MemoryReader(const KeptLevels& texels, const std::vector<TexelLevel>& levels, std::size_t channels)
      : texels_(texels), levels_(levels), channels_(channels) {}
  std::vector<float> rows(std::size_t level, int y0, int y1) override {
    return texels_.rows(level, y0, y1, std::size_t(levels_[level].width) * channels_);
  }
  std::vector<float> tile(std::size_t, int, int) override {
    throw InternalError("images in memory have no tiles");
  }

 private:
  const KeptLevels& texels_;
  const std::vector<TexelLevel>& levels_;
  std::size_t channels_;
};

class MemorySource final : public TexelSource {
 public:
  explicit MemorySource(const Image& image) {
    SPECTRACE_CHECK(image.width > 0 && image.height > 0 && !image.channels.empty());
    channels_ = image.channels.size();
    levels_ = halved_levels(image.width, image.height);
    std::vector<float> finest = image.data;
    std::transform(finest.begin(), finest.end(), finest.begin(), usable_texel);
    texels_.emplace(levels_, 0, channels_, std::vector<std::vector<float>>{std::move(finest)});
  }
  [[nodiscard]] std::unique_ptr<TexelReader> open() const override {
    return std::make_unique<MemoryReader>(*texels_, levels_, channels_);
  }

 private:
  std::optional<KeptLevels> texels_;
};

}  // namespace

std::unique_ptr<TexelSource> texels_in_memory(const Image& image) {
  return std::make_unique<MemorySource>(image);
}

}  // namespace spectrace
