// SPDX-License-Identifier: Apache-2.0
#include "renderer/kernels.h"

#include <algorithm>
#include <array>

#include "core/base/error.h"
#include "core/math/concentric_disk.h"
#include "renderer/path_tracer.h"

namespace spectrace {

namespace {

template <Features kFeatures>
Ray camera_ray(const Camera& camera, const Sampler& sampler, int x, int y) {
  const Vec2 jitter = sampler.get2d(PathDimension::kPixel);
  const Vec2 position{Float(x) + jitter.x, Float(y) + jitter.y};
  if constexpr (kFeatures.depth_of_field) {
    return camera.ray(position, concentric_disk(sampler.get2d(PathDimension::kLens)));
  }
  return camera.ray(position);
}

/// `tile` in pixels of the film, which holds the scene's crop window.
template <Features kFeatures>
void render_tile(const Scene& scene, std::uint64_t seed, SampleRange samples, Tile tile, Film& film) {
  const FlushDenormals flush;
  const CropWindow window = scene.film.window();
  for (int y = tile.y0; y < tile.y1; ++y) {
    for (int x = tile.x0; x < tile.x1; ++x) {
      const int image_x = window.x + x, image_y = window.y + y;
      const std::uint64_t pixel =
          std::uint64_t(image_y) * std::uint64_t(scene.film.width) + std::uint64_t(image_x);
      for (std::uint64_t i = samples.first; i < samples.last; ++i) {
        const Sampler sampler(pixel, i, seed);
        const Ray ray = camera_ray<kFeatures>(scene.camera, sampler, image_x, image_y);
        film.add(x, y, PathTracer<kFeatures>(scene, sampler).trace(ray));
      }
    }
  }
}

// Flags a profile adds to those of the one it starts from.
constexpr Features kDirect{.area_lights = true, .delta_lights = true, .textures = true, .lobe_layers = true};
constexpr Features kBox{.indirect = true, .area_lights = true, .textures = true, .lobe_layers = true};
constexpr Features kStudio{.indirect = true,
                           .area_lights = true,
                           .delta_lights = true,
                           .environment = true,
                           .textures = true,
                           .lobe_layers = true};
constexpr Features with_specular_parts(Features f) {
  f.specular_parts = true;
  return f;
}
constexpr Features kOpaque{.indirect = true,
                           .area_lights = true,
                           .delta_lights = true,
                           .environment = true,
                           .delta_lobes = true,
                           .textures = true,
                           .instances = true,
                           .lobe_layers = true};
constexpr Features kFull = all_features();

constexpr Features without_layers(Features f) {
  f.lobe_layers = false;
  return f;
}

template <Features kFeatures>
constexpr Kernel make_kernel(std::string_view name) {
  return {name, kFeatures, &render_tile<kFeatures>};
}

constexpr std::array kKernels{
    make_kernel<without_layers(kBox)>("box, beauty only"),
    make_kernel<without_layers(kStudio)>("studio, beauty only"),
    make_kernel<kDirect>("direct"),
    make_kernel<kBox>("box"),
    make_kernel<kStudio>("studio"),
    make_kernel<with_specular_parts(kStudio)>("studio, specular parts"),
    make_kernel<kOpaque>("opaque"),
    make_kernel<kFull>("full"),
};

}  // namespace

std::span<const Kernel> kernels() { return kKernels; }

const Kernel& choose_kernel(const Features& needed) {
  const auto it = std::find_if(kKernels.begin(), kKernels.end(),
                               [&](const Kernel& kernel) { return covers(kernel.features, needed); });
  SPECTRACE_CHECK(it != kKernels.end());
  return *it;
}

}  // namespace spectrace
