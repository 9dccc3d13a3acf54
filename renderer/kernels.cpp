// SPDX-License-Identifier: Apache-2.0
#include "renderer/kernels.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <vector>

#include "core/base/error.h"
#include "core/math/concentric_disk.h"
#include "renderer/flush_denormals.h"
#include "renderer/path_tracer.h"

namespace spectrace {

namespace {

template <Features kFeatures>
Ray camera_ray(const Camera& camera, const PathNumbers& numbers, int x, int y) {
  const Vec2 position{Float(x) + numbers.pixel.x, Float(y) + numbers.pixel.y};
  if constexpr (kFeatures.depth_of_field) return camera.ray(position, concentric_disk(numbers.lens));
  return camera.ray(position);
}

template <int kLayers>
void add_to(PixelSums& sums, const PathValue<kLayers>& value) {
  if (!value.valid) {
    ++sums.invalid;
    return;
  }
  ++sums.valid;
  for (std::size_t layer = 0; layer < kLayers; ++layer) {
    for (std::size_t c = 0; c < 3; ++c) sums.xyz[layer][c] += value.xyz[layer][c];
  }
}

/// Paths in step, so that their rays are traced together: of one pixel, whose first rays and the shadow rays
/// from where they end keep together.
template <Features kFeatures>
class Pack {
 public:
  Pack(const Scene& scene, TraceLog* log) : scene_(scene), log_(log) {}

  void add(const Sampler& sampler, int x, int y) {
    const PathNumbers numbers = sampler.path();
    paths_.emplace_back(scene_, sampler, numbers.wavelength,
                        camera_ray<kFeatures>(scene_.camera, numbers, x, y));
  }

  void trace() {
    PacketMask active = (PacketMask(1) << paths_.size()) - 1;
    for (bool coherent = true; active != 0; coherent = false) {
      for_each(active, [&](std::size_t i) { rays_[i] = paths_[i].ray(); });
      note(active, coherent, false);
      scene_.accel.intersect(rays_, active, coherent, hits_);
      PacketMask lit = 0;
      for_each(active, [&](std::size_t i) {
        if (!paths_[i].advance(hits_[i])) active &= ~bit(i);
        if (const std::optional<Ray>& shadow = paths_[i].shadow_ray()) {
          rays_[i] = *shadow;
          lit |= bit(i);
        }
      });
      if (lit != 0) {
        note(lit, coherent, true);
        lit &= ~scene_.accel.occluded(rays_, lit, coherent);
        for_each(lit, [&](std::size_t i) { paths_[i].receive_light(); });
      }
    }
  }

  void finish(PixelSums& sums) {
    for (auto& path : paths_) {
      const auto& value = path.finish();
      counts_.measured += value.measured;
      counts_.extrapolated += value.extrapolated;
      add_to(sums, value);
    }
    paths_.clear();
  }

  [[nodiscard]] const TileCounts& counts() const { return counts_; }

 private:
  void note(PacketMask active, bool coherent, bool is_shadow) {
    counts_.rays += std::uint64_t(std::popcount(active));
    if (log_ != nullptr) log_->push_back({rays_, active, coherent, is_shadow});
  }
  static PacketMask bit(std::size_t i) { return PacketMask(1) << i; }
  template <typename Visit>
  static void for_each(PacketMask mask, const Visit& visit) {
    for (; mask != 0; mask &= mask - 1) visit(std::size_t(std::countr_zero(mask)));
  }

  const Scene& scene_;
  TraceLog* log_;
  TileCounts counts_;
  std::vector<PathTracer<kFeatures>> paths_;
  RayPacket rays_{};
  HitPacket hits_{};
};

template <Features kFeatures>
TileCounts render_tile(const Scene& scene, std::uint64_t seed, SampleRange samples, Tile tile, Film& film,
                       TraceLog* log) {
  const FlushDenormals flush;
  const CropWindow window = scene.film.window();
  Pack<kFeatures> pack(scene, log);
  for (int y = tile.y0; y < tile.y1; ++y) {
    for (int x = tile.x0; x < tile.x1; ++x) {
      const int image_x = window.x + x, image_y = window.y + y;
      const std::uint64_t pixel =
          std::uint64_t(image_y) * std::uint64_t(scene.film.width) + std::uint64_t(image_x);
      PixelSums sums;
      for (std::uint64_t first = samples.first; first < samples.last;) {
        // Packs begin at multiples of their size: ranges that do so too are packed alike.
        const std::uint64_t end = std::min(samples.last, (first / kPacket + 1) * kPacket);
        for (; first < end; ++first) pack.add(Sampler(pixel, first, seed), image_x, image_y);
        pack.trace();
        pack.finish(sums);
      }
      film.add(x, y, sums);
    }
  }
  return pack.counts();
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
