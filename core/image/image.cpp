// SPDX-License-Identifier: Apache-2.0
#include "core/image/image.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/base/error.h"

namespace spectrace {

namespace {

std::string joined(std::string_view layer, std::string_view component) {
  return layer.empty() ? std::string(component) : fmt::format("{}.{}", layer, component);
}

std::string_view layer_of(std::string_view channel) {
  const std::size_t dot = channel.rfind('.');
  return dot == std::string_view::npos ? std::string_view() : channel.substr(0, dot);
}

}  // namespace

std::optional<std::size_t> Image::find_channel(std::string_view name) const {
  const auto it = std::find(channels.begin(), channels.end(), name);
  if (it == channels.end()) return std::nullopt;
  return static_cast<std::size_t>(it - channels.begin());
}

Image Image::select(std::span<const std::string> names, const std::string& file) const {
  std::vector<std::size_t> sources;
  for (const std::string& name : names) {
    const std::optional<std::size_t> c = find_channel(name);
    if (!c) {
      throw InputError(file, "",
                       fmt::format("has no channel \"{}\", only {}", name, fmt::join(channels, ", ")));
    }
    sources.push_back(*c);
  }
  Image chosen(width, height, {names.begin(), names.end()});
  const std::size_t pixels = std::size_t(width) * std::size_t(height);
  for (std::size_t i = 0; i < pixels; ++i) {
    for (std::size_t c = 0; c < sources.size(); ++c) {
      chosen.data[i * sources.size() + c] = data[i * channels.size() + sources[c]];
    }
  }
  return chosen;
}

std::vector<std::string> Image::rgb_layers() const {
  std::vector<std::string> layers;
  for (const std::string& channel : channels) {
    const std::string layer(layer_of(channel));
    if (std::find(layers.begin(), layers.end(), layer) != layers.end()) continue;
    const std::array<std::string, 3> rgb = rgb_channels(layer);
    const bool is_complete = std::all_of(
        rgb.begin(), rgb.end(), [&](const std::string& name) { return find_channel(name).has_value(); });
    if (is_complete && !is_matte_layer(layer)) layers.push_back(layer);
  }
  return layers;
}

bool is_matte_layer(std::string_view layer) {
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  return layer.starts_with("crypto_") && layer.size() > 9 && is_digit(layer.back()) &&
         is_digit(layer[layer.size() - 2]);
}

std::array<std::string, 3> rgb_channels(std::string_view layer) {
  return {joined(layer, "R"), joined(layer, "G"), joined(layer, "B")};
}

}  // namespace spectrace
