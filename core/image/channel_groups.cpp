// SPDX-License-Identifier: Apache-2.0
#include "core/image/channel_groups.h"

#include <algorithm>
#include <array>
#include <utility>

#include "core/image/spectral_image.h"

namespace spectrace {

namespace {

constexpr std::array<std::pair<const char*, SpectralKind>, 2> kSpectra{
    {{"S0", SpectralKind::kRadiance}, {"T", SpectralKind::kReflectance}}};

ChannelGroup spectrum_group(const char* name, std::span<const SpectralChannel> found) {
  ChannelGroup group{.name = name, .kind = GroupKind::kSpectrum, .channels = {}, .indices = {}};
  for (const SpectralChannel& channel : found) {
    group.channels.push_back(channel.name);
    group.indices.push_back(channel.index);
    group.lambda_nm.push_back(channel.lambda_nm);
  }
  return group;
}

/// R, G, B of `layer` ("" for those without a dot) where the image has all three.
bool make_colour(const Image& image, const std::string& layer, ChannelGroup& group) {
  if (is_matte_layer(layer)) return false;
  const auto names = rgb_channels(layer);
  std::vector<std::size_t> indices;
  for (const std::string& name : names) {
    const auto index = image.find_channel(name);
    if (!index) return false;
    indices.push_back(*index);
  }
  group.kind = GroupKind::kColour;
  group.channels.assign(names.begin(), names.end());
  group.indices = std::move(indices);
  return true;
}

}  // namespace

std::vector<ChannelGroup> channel_groups(const Image& image, const std::string& file) {
  std::vector<ChannelGroup> groups;
  std::vector<bool> is_taken(image.channels.size(), false);
  std::vector<ChannelGroup> spectra;
  for (const auto& [name, kind] : kSpectra) {
    const std::vector<SpectralChannel> found = find_spectral_channels(image.channels, kind, file);
    if (found.empty()) continue;
    spectra.push_back(spectrum_group(name, found));
    for (const SpectralChannel& channel : found) is_taken[channel.index] = true;
  }
  for (std::size_t c = 0; c < image.channels.size(); ++c) {
    if (is_taken[c]) continue;
    const std::string& channel = image.channels[c];
    const std::size_t dot = channel.rfind('.');
    const std::string layer = dot == std::string::npos ? "" : channel.substr(0, dot);
    ChannelGroup colour{.name = layer.empty() ? "beauty" : layer, .channels = {}, .indices = {}};
    const bool has_colour = make_colour(image, layer, colour);
    const bool is_of_colour =
        has_colour && (!layer.empty() || std::find(colour.channels.begin(), colour.channels.end(), channel) !=
                                             colour.channels.end());
    const std::string name = is_of_colour ? colour.name : layer.empty() ? channel : layer;
    const auto known =
        std::find_if(groups.begin(), groups.end(), [&](const ChannelGroup& g) { return g.name == name; });
    if (known == groups.end()) {
      groups.push_back(is_of_colour ? colour
                                    : ChannelGroup{.name = name, .channels = {channel}, .indices = {c}});
    } else if (known->kind == GroupKind::kNumbers) {
      known->channels.push_back(channel);
      known->indices.push_back(c);
    }
  }
  groups.insert(groups.end(), spectra.begin(), spectra.end());
  return groups;
}

const ChannelGroup* find_group(std::span<const ChannelGroup> groups, std::string_view name) {
  const auto found =
      std::find_if(groups.begin(), groups.end(), [&](const ChannelGroup& g) { return g.name == name; });
  return found == groups.end() ? nullptr : &*found;
}

std::string variance_of(std::string_view layer) { return std::string(layer) + "_variance"; }

bool is_statistic(const ChannelGroup& group, std::span<const ChannelGroup> groups) {
  for (const std::string_view suffix : {"_variance", "_a", "_b"}) {
    if (!group.name.ends_with(suffix)) continue;
    const std::string_view whole = std::string_view(group.name).substr(0, group.name.size() - suffix.size());
    if (find_group(groups, whole) != nullptr) return true;
  }
  return false;
}

Image group_image(const Image& image, const ChannelGroup& group) {
  Image chosen(image.width, image.height, group.channels);
  const std::size_t n = group.indices.size(), all = image.channels.size();
  for (std::size_t pixel = 0; pixel * n < chosen.data.size(); ++pixel) {
    for (std::size_t c = 0; c < n; ++c)
      chosen.data[pixel * n + c] = image.data[pixel * all + group.indices[c]];
  }
  return chosen;
}

}  // namespace spectrace
