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
#include "renderer/matte.h"
#include "renderer/path_tracer.h"
#include "renderer/pixel_sums.h"
#include "renderer/sample_sums.h"

namespace spectrace {

namespace {

template <Features kFeatures>
Ray camera_ray(const Camera& camera, const PathNumbers& numbers, int x, int y) {
  const Vec2 position{Float(x) + numbers.pixel.x, Float(y) + numbers.pixel.y};
  if constexpr (kFeatures.depth_of_field) return camera.ray(position, concentric_disk(numbers.lens));
  return camera.ray(position);
}

/// As many places of a pixel's row as a kernel fills.
template <Features kFeatures>
constexpr std::size_t row_size() {
  if (kFeatures.more_aovs) return slots::kCount;
  const Layer last = kFeatures.specular_parts ? Layer::kSpecularResidual
                     : kFeatures.lobe_layers  ? Layer::kBackground
                                              : Layer::kBeauty;
  return slots::xyz(last) + slots::kFour;
}

/// What the samples of one leaf bring to a pixel.
template <Features kFeatures>
struct LeafSums {
  PixelSums<row_size<kFeatures>()> row;
  std::vector<float> bins;

  void clear() {
    row = {};
    std::fill(bins.begin(), bins.end(), 0.0F);
  }
  LeafSums& operator+=(const LeafSums& other) {
    row += other.row;
    for (std::size_t i = 0; i < bins.size(); ++i) bins[i] += other.bins[i];
    return *this;
  }
};

/// Each lane's radiance into the bin of its wavelength.
void add_to_bins(std::vector<float>& sums, const FilmLayout& layout, const LaneDeposits& lanes) {
  const SpectralBins& bins = *layout.bins;
  for (std::size_t d = 0; d < lanes.count; ++d) {
    const LaneDeposits::Deposit& deposit = lanes.deposits[d];
    for (int lane = 0; lane < kLanes; ++lane) {
      const double pdf = double(deposit.lambda.pdf_per_nm(lane));
      const std::size_t bin = bins.bin_of(deposit.lambda.lambda_nm(lane));
      if (!(pdf > 0) || bin == bins.count) continue;  // a terminated lane says nothing
      const double weight = 1 / (pdf * kLanes * bins.width_nm());
      for (std::size_t i = 0; i < kSpectralLayers.size(); ++i) {
        const Layer layer = kSpectralLayers[i];
        if (!layout.bin_layers.has(layer)) continue;
        sums[layout.bin_layers.slot(layer) * bins.count + bin] +=
            static_cast<float>(deposit.radiance[i].v[std::size_t(lane)] * weight);
      }
    }
  }
}

template <Features kFeatures>
void add_to(LeafSums<kFeatures>& sums, const PathValue<kFeatures>& value, const FilmLayout& layout,
            bool is_in_b) {
  auto& row = sums.row.v;
  if (!value.valid) {
    row[slots::kInvalid] += 1;
    if constexpr (kFeatures.more_aovs) row[slots::kInvalidB] += is_in_b ? 1 : 0;
    return;
  }
  constexpr LayerSet kLayers = layer_set(kFeatures);
  for_each_layer<kLayers>([&](auto layer) {
    if (!value.lit.has(layer)) return;
    const PathXyz& xyz = value.xyz[kLayers.slot(layer)];
    for (std::size_t c = 0; c < xyz.size(); ++c) row[slots::xyz(layer) + c] += xyz[c];
    constexpr auto kMoment = std::size_t(decltype(layer)::value);
    if constexpr (kFeatures.more_aovs && kMoment < kMomentLayers) add_moment(kMoment, xyz, is_in_b, row);
  });
  if constexpr (kFeatures.more_aovs) {
    if (value.extrapolated != 0) row[slots::kExtrapolated] += value.extrapolated;
    if (value.first_hit.is_known) add_features(value.first_hit.features, row);
  }
  if constexpr (kFeatures.spectral_film) {
    if (layout.bins) add_to_bins(sums.bins, layout, value.lanes);
  }
}

/// Paths in step, so that their rays are traced together: of one pixel, whose first rays and the shadow rays
/// from where they end keep together.
template <Features kFeatures>
class Pack {
 public:
  Pack(const RenderJob& job, TraceLog* log) : job_(job), scene_(job.scene), log_(log) {}

  void add(const Sampler& sampler, int x, int y) {
    const PathNumbers numbers = sampler.path();
    paths_.emplace_back(job_, sampler, numbers.wavelength,
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

  /// `mattes`: of the pixel; those that the layout does not have stay empty.
  void finish(LeafSums<kFeatures>& sums, [[maybe_unused]] PixelMattes& mattes) {
    std::size_t sample = 0;
    const std::size_t first_in_b = paths_.size() - samples_in_half_b({0, 1}, paths_.size());
    for (auto& path : paths_) {
      const auto& value = path.finish();
      counts_.measured += value.measured;
      counts_.extrapolated += value.extrapolated;
      add_to<kFeatures>(sums, value, job_.layout, sample++ >= first_in_b);
      if constexpr (kFeatures.more_aovs) add_to_mattes(mattes, value);
    }
    paths_.clear();
  }

  [[nodiscard]] const TileCounts& counts() const { return counts_; }

 private:
  void add_to_mattes(PixelMattes& mattes, const PathValue<kFeatures>& value) const {
    const FirstSurface& seen = value.first_hit.surface;
    if (!value.valid || !seen.is_known) return;
    const MatteNames& names = scene_.matte_names;
    if (job_.layout.aovs.crypto_object) {
      mattes[std::size_t(Matte::kObject)].add(seen.instance != kNone ? names.id_of_instance[seen.instance]
                                                                     : names.id_of_shape[seen.shape]);
    }
    if (job_.layout.aovs.crypto_material) {
      mattes[std::size_t(Matte::kMaterial)].add(names.id_of_material[seen.material]);
    }
  }
  void note(PacketMask active, bool coherent, bool is_shadow) {
    counts_.rays += std::uint64_t(std::popcount(active));
    if (log_ != nullptr) log_->push_back({rays_, active, coherent, is_shadow});
  }
  static PacketMask bit(std::size_t i) { return PacketMask(1) << i; }
  template <typename Visit>
  static void for_each(PacketMask mask, const Visit& visit) {
    for (; mask != 0; mask &= mask - 1) visit(std::size_t(std::countr_zero(mask)));
  }

  const RenderJob& job_;
  const Scene& scene_;
  TraceLog* log_;
  TileCounts counts_;
  std::vector<PathTracer<kFeatures>> paths_;
  RayPacket rays_{};
  HitPacket hits_{};
};

template <Features kFeatures>
TileCounts render_tile(const RenderJob& job, SampleRange samples, Tile tile, TileSums& sums, TraceLog* log) {
  static_assert(kLeafSamples == kPacket, "a leaf is what is traced together");
  const FlushDenormals flush;
  const FilmDesc& film = job.scene.film;
  const CropWindow window = film.window();
  const std::size_t bins = job.layout.bins_per_pixel();
  BlockSum<LeafSums<kFeatures>> block({.row = {}, .bins = std::vector<float>(bins)});
  sums.rows.resize(tile.pixels() * job.kept_slots.size());
  const std::span<const std::size_t> kept_slots(job.kept_slots);
  double* kept = sums.rows.data();
  sums.bins.clear();
  for (MatteCounts& counts : sums.mattes) counts.clear();
  PixelMattes mattes;
  Pack<kFeatures> pack(job, log);
  for (int y = tile.y0; y < tile.y1; ++y) {
    for (int x = tile.x0; x < tile.x1; ++x) {
      const int image_x = window.x + x, image_y = window.y + y;
      const std::uint64_t pixel = std::uint64_t(image_y) * std::uint64_t(film.width) + std::uint64_t(image_x);
      block.clear();
      for (std::uint64_t first = samples.first; first < samples.last; first += kLeafSamples) {
        const std::uint64_t end = std::min(samples.last, first + kLeafSamples);
        for (std::uint64_t i = first; i < end; ++i) {
          pack.add(Sampler(pixel, i, job.seed, job.scene.sampler), image_x, image_y);
        }
        pack.trace();
        LeafSums<kFeatures>& leaf = block.begin_leaf();
        leaf.clear();
        pack.finish(leaf, mattes);
        block.end_leaf();
      }
      const LeafSums<kFeatures>& sum = block.sum();
      kept = std::transform(kept_slots.begin(), kept_slots.end(), kept,
                            [&](std::size_t slot) { return sum.row.v[slot]; });
      sums.bins.insert(sums.bins.end(), sum.bins.begin(), sum.bins.end());
      if constexpr (kFeatures.more_aovs) {
        const auto film_pixel = std::uint32_t(y) * std::uint32_t(window.width) + std::uint32_t(x);
        for (std::size_t m = 0; m < kMatteKinds; ++m) mattes[m].move_to(film_pixel, sums.mattes[m]);
      }
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

constexpr Features with_more_aovs(Features f) {
  f.more_aovs = true;
  return f;
}
constexpr Features without_layers(Features f) {
  f.lobe_layers = false;
  return f;
}

/// Those of this build: all, but for what tests/bench/unused_effects.py takes out.
constexpr Features existing(Features f) {
#ifdef SPECTRACE_WITHOUT_EFFECT
  f.SPECTRACE_WITHOUT_EFFECT = false;
#endif
  return f;
}

template <Features kFeatures>
constexpr Kernel make_kernel(std::string_view name) {
  return {name, existing(kFeatures), &render_tile<existing(kFeatures)>};
}

constexpr std::array kKernels{
    make_kernel<without_layers(kBox)>("box, beauty only"),
    make_kernel<without_layers(kStudio)>("studio, beauty only"),
    make_kernel<kDirect>("direct"),
    make_kernel<kBox>("box"),
    make_kernel<kStudio>("studio"),
    make_kernel<with_specular_parts(kStudio)>("studio, specular parts"),
    make_kernel<with_more_aovs(kBox)>("box, AOVs"),
    make_kernel<with_more_aovs(kStudio)>("studio, AOVs"),
    make_kernel<with_more_aovs(with_specular_parts(kStudio))>("studio, specular parts, AOVs"),
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
