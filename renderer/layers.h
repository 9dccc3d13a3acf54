// SPDX-License-Identifier: Apache-2.0
// What light is parted into: the layers of an image, and sets of them.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <type_traits>
#include <utility>

namespace spectrace {

/// Beauty = diffuse + specular + emission + background; specular = the sum of its three parts, of which the
/// last two are signed (paper, eq. 21; ADR 0007). Direct: what lights send to the first hit that is no mirror
/// or smooth glass, without another scattering in between.
enum class Layer : std::uint8_t {
  kBeauty,
  kDiffuse,
  kSpecular,
  kEmission,
  kBackground,
  kSpecularFresnel,
  kSpecularDiffraction,
  kSpecularResidual,
  kDiffuseDirect,
  kSpecularDirect,
};
inline constexpr int kLayerCount = 10;

/// As channels are named: "" for the beauty.
[[nodiscard]] constexpr std::string_view layer_name(Layer layer) {
  constexpr std::string_view kNames[kLayerCount]{"",
                                                 "diffuse",
                                                 "specular",
                                                 "emission",
                                                 "background",
                                                 "specular_fresnel",
                                                 "specular_diffraction",
                                                 "specular_residual",
                                                 "diffuse_direct",
                                                 "specular_direct"};
  return kNames[std::size_t(layer)];
}
[[nodiscard]] constexpr bool is_signed(Layer layer) {
  return layer == Layer::kSpecularDiffraction || layer == Layer::kSpecularResidual;
}

/// A set of layers that a kernel gathers side by side, in the order of Layer.
struct LayerSet {
  constexpr LayerSet() = default;
  template <typename... Layers>
  constexpr explicit LayerSet(Layers... layers) : bits((0U | ... | bit(layers))) {}

  [[nodiscard]] constexpr bool has(Layer layer) const { return (bits & bit(layer)) != 0; }
  [[nodiscard]] constexpr std::size_t size() const { return std::size_t(std::popcount(bits)); }
  /// Where a layer of the set stands in it.
  [[nodiscard]] constexpr std::size_t slot(Layer layer) const {
    return std::size_t(std::popcount(bits & (bit(layer) - 1)));
  }
  template <typename Visit>
  constexpr void for_each(const Visit& visit) const {
    for (unsigned left = bits; left != 0; left &= left - 1) visit(Layer(std::countr_zero(left)));
  }
  friend constexpr LayerSet operator|(LayerSet a, LayerSet b) {
    a.bits |= b.bits;
    return a;
  }
  friend constexpr LayerSet operator&(LayerSet a, LayerSet b) {
    a.bits &= b.bits;
    return a;
  }
  friend constexpr bool operator==(LayerSet, LayerSet) = default;

  static constexpr unsigned bit(Layer layer) { return 1U << unsigned(layer); }
  unsigned bits = 0;  // public: a set is a template argument
};

/// Calls `visit` with each layer as a constant, in their order: for hot paths, which know their slots when
/// they are compiled.
template <LayerSet kLayers, typename Visit>
constexpr void for_each_layer(const Visit& visit) {
  const auto visit_one = [&]<std::size_t kIndex>() {
    if constexpr (kLayers.has(Layer(kIndex))) visit(std::integral_constant<Layer, Layer(kIndex)>());
  };
  [&]<std::size_t... kIndices>(std::index_sequence<kIndices...>) {
    (visit_one.template operator()<kIndices>(), ...);
  }
  (std::make_index_sequence<kLayerCount>());
}

inline constexpr LayerSet kBeautyLayer(Layer::kBeauty);
inline constexpr LayerSet kLobeLayers(Layer::kDiffuse, Layer::kSpecular, Layer::kEmission,
                                      Layer::kBackground);
inline constexpr LayerSet kSpecularParts(Layer::kSpecularFresnel, Layer::kSpecularDiffraction,
                                         Layer::kSpecularResidual);
inline constexpr LayerSet kDirectLayers(Layer::kDiffuseDirect, Layer::kSpecularDirect);

}  // namespace spectrace
