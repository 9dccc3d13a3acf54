// SPDX-License-Identifier: Apache-2.0
#include "renderer/aov_names.h"

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

namespace spectrace {

namespace {

using Renaming = std::pair<std::string_view, std::string_view>;

constexpr std::array kBlender{Renaming{"", "ViewLayer.Combined"},
                              Renaming{"diffuse_direct", "ViewLayer.DiffDir"},
                              Renaming{"diffuse_indirect", "ViewLayer.DiffInd"},
                              Renaming{"diffuse_albedo", "ViewLayer.DiffCol"},
                              Renaming{"specular_direct", "ViewLayer.GlossDir"},
                              Renaming{"specular_indirect", "ViewLayer.GlossInd"},
                              Renaming{"specular_albedo", "ViewLayer.GlossCol"},
                              Renaming{"emission", "ViewLayer.Emit"},
                              Renaming{"background", "ViewLayer.Env"},
                              Renaming{"normal", "ViewLayer.Normal"},
                              Renaming{"depth", "ViewLayer.Depth"},
                              Renaming{"position", "ViewLayer.Position"}};

constexpr std::array kKpcn{
    Renaming{"diffuse_variance", "diffuseVariance"}, Renaming{"specular_variance", "specularVariance"},
    Renaming{"albedo_variance", "albedoVariance"}, Renaming{"normal_variance", "normalVariance"},
    Renaming{"depth_variance", "depthVariance"}};

template <std::size_t kCount>
void rename(const std::array<Renaming, kCount>& renamings, Image& image) {
  for (std::string& channel : image.channels) {
    const std::size_t dot = channel.rfind('.');
    const std::string_view layer =
        dot == std::string::npos ? std::string_view() : std::string_view(channel).substr(0, dot);
    for (const auto& [ours, theirs] : renamings) {
      if (layer != ours) continue;
      channel = std::string(theirs) + '.' + channel.substr(dot == std::string::npos ? 0 : dot + 1);
      break;
    }
  }
}

/// `layer` over `albedo`, so that their product is what it was; 0 where there is no albedo.
void divide(Image& image, const std::string& layer, const std::string& albedo) {
  const std::size_t stride = image.channels.size();
  for (const char* component : {".R", ".G", ".B"}) {
    const auto of = image.find_channel(layer + component), by = image.find_channel(albedo + component);
    if (!of || !by) return;
    for (std::size_t i = 0; i < image.data.size(); i += stride) {
      const float divisor = image.data[i + *by];
      image.data[i + *of] = divisor > 0 ? image.data[i + *of] / divisor : 0.0F;
    }
  }
}

}  // namespace

void use_names(AovNames names, Image& image) {
  if (names == AovNames::kKpcn) rename(kKpcn, image);
  if (names != AovNames::kBlender) return;
  for (const char* lobe : {"diffuse", "specular"}) {
    for (const char* part : {"_direct", "_indirect"}) {
      divide(image, std::string(lobe) + part, std::string(lobe) + "_albedo");
    }
  }
  rename(kBlender, image);
}

}  // namespace spectrace
