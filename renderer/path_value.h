// SPDX-License-Identifier: Apache-2.0
// What one path from the camera brings to the film: as much as a kernel's features want of it.
#pragma once

#include <array>
#include <cstdint>
#include <type_traits>

#include "core/spectra/lane_to_xyz.h"
#include "renderer/features.h"
#include "renderer/first_hit.h"
#include "renderer/layers.h"

namespace spectrace {

/// Type of a member that only some kernels have.
template <typename T>
struct Unwanted {};
template <bool kIsWanted, typename T>
using IfWanted = std::conditional_t<kIsWanted, T, Unwanted<T>>;

template <Features kFeatures>
struct PathValue {
  static constexpr LayerSet kLayers = layer_set(kFeatures);

  std::array<PathXyz, kLayers.size()> xyz;  ///< of layers that are not lit: anything
  LayerSet lit;                             ///< the other layers are 0
  bool valid = true;                        ///< all of it finite and, where a layer is not signed, >= 0
  /// Vertices on measured BRDFs, and those of them seen from beyond the last measured elevation.
  std::uint32_t measured = 0, extrapolated = 0;
  [[no_unique_address]] IfWanted<kFeatures.more_aovs, FirstHit> first_hit;
  [[no_unique_address]] IfWanted<kFeatures.spectral_film, LaneDeposits> lanes;

  void add(Layer layer, const PathXyz& more) {
    PathXyz& sum = xyz[kLayers.slot(layer)];
    if (lit.has(layer)) {
      for (std::size_t c = 0; c < sum.size(); ++c) sum[c] += more[c];
    } else {
      sum = more;
      lit = lit | LayerSet(layer);
    }
  }
};

}  // namespace spectrace
