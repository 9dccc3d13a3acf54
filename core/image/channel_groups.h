// SPDX-License-Identifier: Apache-2.0
// Which channels of an image belong together: the layers of EXR files, spectra among them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/image/image.h"

namespace spectrace {

enum class GroupKind : std::uint8_t {
  kColour,    ///< R, G, B
  kSpectrum,  ///< a channel a wavelength
  kNumbers,   ///< anything else: normal.X, Y, Z; depth.Z
};

struct ChannelGroup {
  /// What stands before the last dot ("diffuse", "S0"); "beauty" for R, G, B without one; the channel's own
  /// name for any other without one.
  std::string name;
  GroupKind kind = GroupKind::kNumbers;
  std::vector<std::string> channels;  ///< names; of a colour R, G, B alone, whatever else the layer has
  std::vector<std::size_t> indices;   ///< their places in Image::channels
  std::vector<double> lambda_nm{};    ///< of a spectrum, rising; else empty
};

/// In the order of the channels. Throws InputError naming `file` where a spectral channel's name is wrong.
[[nodiscard]] std::vector<ChannelGroup> channel_groups(const Image& image, const std::string& file);
/// Null where none has that name.
[[nodiscard]] const ChannelGroup* find_group(std::span<const ChannelGroup> groups, std::string_view name);

/// A layer's statistics are layers of their own: its variance of the mean, its halves of even and odd
/// samples.
[[nodiscard]] std::string variance_of(std::string_view layer);  ///< "diffuse" -> "diffuse_variance"
/// A variance or a half of another of `groups`.
[[nodiscard]] bool is_statistic(const ChannelGroup& group, std::span<const ChannelGroup> groups);

/// The group's channels as an image of their own.
[[nodiscard]] Image group_image(const Image& image, const ChannelGroup& group);

}  // namespace spectrace
