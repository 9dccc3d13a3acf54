// SPDX-License-Identifier: Apache-2.0
// The radiance that a path gathers, lane by lane, in layers.
#pragma once

#include <array>
#include <optional>

#include "core/spectra/lane_to_xyz.h"
#include "renderer/layers.h"
#include "renderer/lobe_shares.h"

namespace spectrace {

/// What a path has gathered, by layer.
template <LayerSet kLayers>
class LayerSums {
 public:
  /// To be added to.
  [[nodiscard]] LaneSums& operator[](Layer layer) {
    LaneSums& sums = lanes_[kLayers.slot(layer)];
    if (!lit_.has(layer)) sums = {};
    lit_ = lit_ | LayerSet(layer);
    return sums;
  }

  /// What something was added to; the other layers are 0.
  [[nodiscard]] LayerSet lit() const { return lit_; }
  /// Of a layer that is lit.
  [[nodiscard]] const LaneSums& of(Layer layer) const { return lanes_[kLayers.slot(layer)]; }
  /// What was added to the beauty went whole to `layers`; the others differ from it from now on.
  void went_whole_to(LayerSet layers) { beauty_ = beauty_ & layers; }
  /// The layer is the beauty, to the bit.
  [[nodiscard]] bool is_beauty(Layer layer) const { return beauty_.has(layer); }
  void clear() {
    lit_ = {};
    beauty_ = kLayers;
  }

 private:
  std::array<LaneSums, kLayers.size()> lanes_;  // of layers that are not lit: anything
  LayerSet lit_, beauty_ = kLayers;
};

/// Adds `radiance`, which the beauty has got, to the lobes' layers.
template <LayerSet kLayers>
void add_split(LayerSums<kLayers>& sums, const SampledSpectrum& radiance, const LobeShares& share,
               [[maybe_unused]] bool is_direct) {
  if (share.only) {
    const bool diffuse = *share.only == Lobe::kDiffuse;
    LayerSet layers;
    const auto add = [&](Layer layer) {
      sums[layer] += radiance;
      layers = layers | LayerSet(layer);
    };
    add(diffuse ? Layer::kDiffuse : Layer::kSpecular);
    if constexpr (kLayers.has(Layer::kSpecularFresnel)) {
      if (!diffuse) add(Layer::kSpecularFresnel);
    }
    if constexpr (kLayers.has(Layer::kDiffuseDirect)) {
      if (is_direct) add(diffuse ? Layer::kDiffuseDirect : Layer::kSpecularDirect);
    }
    sums.went_whole_to(layers);
    return;
  }
  sums.went_whole_to({});
  const auto part = [](Float all, Float of_it) { return double(all) * double(of_it); };
  const auto rest = [](Float all, Float of_it) { return double(all) - double(all) * double(of_it); };
  sums[Layer::kDiffuse].add(part, radiance, share.diffuse);
  sums[Layer::kSpecular].add(rest, radiance, share.diffuse);
  if constexpr (kLayers.has(Layer::kSpecularFresnel)) {
    const auto residual = [&](Float all, Float diffuse, Float fresnel, Float diffraction) {
      return rest(all, diffuse) - part(all, fresnel) - part(all, diffraction);
    };
    sums[Layer::kSpecularFresnel].add(part, radiance, share.fresnel);
    sums[Layer::kSpecularDiffraction].add(part, radiance, share.diffraction);
    sums[Layer::kSpecularResidual].add(residual, radiance, share.diffuse, share.fresnel, share.diffraction);
  }
  if constexpr (kLayers.has(Layer::kDiffuseDirect)) {
    if (!is_direct) return;
    sums[Layer::kDiffuseDirect].add(part, radiance, share.diffuse);
    sums[Layer::kSpecularDirect].add(rest, radiance, share.diffuse);
  }
}

}  // namespace spectrace
