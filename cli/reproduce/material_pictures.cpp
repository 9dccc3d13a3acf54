// SPDX-License-Identifier: Apache-2.0
#include "cli/reproduce/material_pictures.h"

#include <algorithm>
#include <utility>

#include "core/base/error.h"
#include "renderer/render.h"

namespace spectrace::cli {

Image Picture::rgb(const std::string& layer) const { return layers.select(rgb_channels(layer), name); }

bool Picture::has(const std::string& layer) const {
  const std::vector<std::string> all = layers.rgb_layers();
  return std::find(all.begin(), all.end(), layer) != all.end();
}

Picture take_picture(std::string name, Scene& scene, PairedBrdf::Values values,
                     const SeparatedBrdf& directions, const PictureOptions& options) {
  SPECTRACE_CHECK(scene.materials.size() == 1);
  scene.materials.front() = PairedBrdf(std::move(values), directions);
  SilentProgress progress;
  const RenderResult result =
      render(scene, {.spp = options.spp, .seed = options.seed, .threads = options.threads}, progress);
  const Image& image = result.image;
  std::vector<std::string> kept;
  for (const std::string& channel : image.channels) {
    const bool is_background = channel.starts_with("background.") || channel.starts_with("emission.") ||
                               channel.starts_with("diagnostics.");
    if (!is_background) kept.push_back(channel);
  }
  Picture picture{.name = name,
                  .layers = image.select(kept, name),
                  .invalid_samples = static_cast<std::int64_t>(result.report.invalid_samples)};
  const Image diffuse = image.select(rgb_channels("diffuse"), name);
  const Image specular = image.select(rgb_channels("specular"), name);
  const std::size_t n = kept.size();
  for (std::size_t i = 0; i < diffuse.data.size(); ++i) {
    picture.layers.data[i / 3 * n + i % 3] = diffuse.data[i] + specular.data[i];
  }
  return picture;
}

}  // namespace spectrace::cli
