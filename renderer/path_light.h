// SPDX-License-Identifier: Apache-2.0
// The light that one path gathers: parted by the lobes of its first non-delta hit where a kernel has layers,
// and light that waits for its shadow ray.
#pragma once

#include "core/spectra/lane_to_xyz.h"
#include "renderer/layer_sums.h"
#include "renderer/path_value.h"

namespace spectrace {

template <Features kFeatures>
class PathLight {
 public:
  /// Radiance met after `depth` scatterings. It goes to the first non-delta hit's lobes in its shares; seen
  /// without one, to `kDirect` (camera) or to the specular layer (through mirrors and glass).
  template <Layer kDirect>
  void add(const SampledSpectrum& radiance, [[maybe_unused]] int depth) {
    sums_[Layer::kBeauty] += radiance;
    if constexpr (kFeatures.lobe_layers) {
      if (depth == 0) {
        sums_[kDirect] += radiance;
        sums_.went_whole_to(LayerSet(kDirect));
      } else if (!split_.is_made) {
        sums_[Layer::kSpecular] += radiance;
        if constexpr (kFeatures.specular_parts) sums_[Layer::kSpecularFresnel] += radiance;
        if constexpr (kLayers.has(Layer::kSpecularDirect)) {
          if (depth == 1) sums_[Layer::kSpecularDirect] += radiance;
        }
        sums_.went_whole_to(LayerSet(Layer::kSpecular));
      } else {
        add_split(sums_, radiance, split_.share, depth == split_.depth + 1);
      }
    }
  }

  /// Comes unless something lies between.
  void await(const SampledSpectrum& radiance) {
    awaited_ = radiance;
    if constexpr (kFeatures.lobe_layers) awaited_lobes_.is_direct = !split_.is_made;
  }
  /// Of a kernel with layers: where the awaited light's shares belong; null where those of an earlier hit
  /// hold.
  [[nodiscard]] LobeShares* shares_of_awaited() {
    return awaited_lobes_.is_direct ? &awaited_lobes_.share : nullptr;
  }
  void dim_awaited(Float factor) { awaited_ *= factor; }
  void receive_awaited() {
    sums_[Layer::kBeauty] += awaited_;
    if constexpr (kFeatures.lobe_layers) {
      const bool is_direct = awaited_lobes_.is_direct;
      add_split(sums_, awaited_, is_direct ? awaited_lobes_.share : split_.share, is_direct);
    }
  }

  /// Of a kernel with layers: the first non-delta hit has been.
  [[nodiscard]] bool is_split() const { return split_.is_made; }
  /// It is the scattering of this depth; its shares are to be filled in.
  [[nodiscard]] LobeShares& split_at(int depth) {
    split_.is_made = true;
    split_.depth = depth;
    return split_.share;
  }

  /// Turns the lanes gathered so far into XYZ, under the densities they were gathered with.
  void move_to(const SampledWavelengths& lambda, PathValue<kFeatures>& value) {
    const LaneToXyz weights(lambda);
    if constexpr (kFeatures.spectral_film) value.lanes.add(lambda, sums_);
    PathXyz beauty{};
    for_each_layer<kLayers>([&](auto layer) {
      if (!sums_.lit().has(layer)) return;  // most layers of most paths
      PathXyz xyz = beauty;
      if (layer == Layer::kBeauty || !sums_.is_beauty(layer)) {  // often one lobe has all of it
        xyz = {};
        value.valid &= weights.add(sums_.of(layer), xyz, is_signed(layer));
      }
      if (layer == Layer::kBeauty) beauty = xyz;
      value.add(layer, xyz);
    });
    sums_.clear();
  }

 private:
  static constexpr LayerSet kLayers = layer_set(kFeatures);

  /// The first non-delta hit parts what arrives from behind it by lobe.
  struct LobeSplit {
    bool is_made = false;
    int depth = 0;
    LobeShares share;
  };
  struct AwaitedLobes {
    LobeShares share;
    bool is_direct = false;
  };

  LayerSums<kLayers> sums_;
  SampledSpectrum awaited_;
  [[no_unique_address]] IfWanted<kFeatures.lobe_layers, LobeSplit> split_;
  [[no_unique_address]] IfWanted<kFeatures.lobe_layers, AwaitedLobes> awaited_lobes_;
};

}  // namespace spectrace
