// SPDX-License-Identifier: Apache-2.0
// Images in memory, in and out: EXR (OpenEXR), everything else (OpenImageIO).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace spectrace {

/// width x height pixels of named float channels, interleaved, row 0 at the top.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::string> channels;  ///< "R", "G", "B", "diffuse.R", "normal.X", ...
  std::vector<float> data;            ///< [height][width][channels]

  Image() = default;
  Image(int w, int h, std::vector<std::string> names)
      : width(w), height(h), channels(std::move(names)), data(std::size_t(w) * h * channels.size()) {}

  [[nodiscard]] std::size_t index(int x, int y, std::size_t c) const {
    return (std::size_t(y) * width + x) * channels.size() + c;
  }
  [[nodiscard]] float& at(int x, int y, std::size_t c) { return data[index(x, y, c)]; }
  [[nodiscard]] float at(int x, int y, std::size_t c) const { return data[index(x, y, c)]; }
  [[nodiscard]] std::optional<std::size_t> find_channel(std::string_view name) const;
  /// The named channels as an image of their own, in that order; throws InputError naming `file` where one is
  /// missing.
  [[nodiscard]] Image select(std::span<const std::string> names, const std::string& file) const;
  /// Layers: "" for R,G,B, "diffuse" for diffuse.R,G,B, ...: every prefix with all of R, G, B.
  [[nodiscard]] std::vector<std::string> rgb_layers() const;
};

/// "crypto_object00" ...: ids and coverages (Cryptomatte), so that R, G, B are no colour.
[[nodiscard]] bool is_matte_layer(std::string_view layer);

/// The channels of an RGB layer: "diffuse" -> diffuse.R, diffuse.G, diffuse.B.
[[nodiscard]] std::array<std::string, 3> rgb_channels(std::string_view layer);

/// Header attributes: what went in, what the numbers mean.
using Metadata = std::map<std::string, std::variant<std::string, double, std::int64_t>>;

/// Float32, ZIP; written aside and renamed. Non-finite values are written as they are. EXR has no 64-bit
/// integers: one that does not fit 32 bits is written as text.
void write_exr(const std::filesystem::path& file, const Image& image, const Metadata& metadata);
/// 8-bit sRGB of one RGB layer ("" = beauty), scaled by `exposure` and clipped to [0, 1]; non-finite pixels
/// are painted magenta, so that they are seen.
void write_png(const std::filesystem::path& file, const Image& image, std::string_view layer = "",
               double exposure = 1);

/// The same pixels inside a "data:" address, for pages that must stand alone; PNG where every pixel counts.
std::string png_data_uri(const Image& image, std::string_view layer = "", double exposure = 1);
std::string jpeg_data_uri(const Image& image, std::string_view layer = "", double exposure = 1);

/// EXR (its first part, the data window), told by content; else what OpenImageIO reads by name: HDR, PNG,
/// JPEG,
/// ... Integer pixels are decoded from sRGB to linear unless the file says that they are linear; grey becomes
/// R, G, B. Channels come layer by layer, within each R, G, B, A or X, Y, Z, then by name. Throws InputError
/// where the file is damaged, not an image, or has more than `max_pixels`; the memory used before is bounded.
Image read_image(const std::filesystem::path& file, std::size_t max_pixels = std::size_t(1) << 28);
/// Header attributes that are texts or numbers; without those that describe the pixels' layout.
Metadata read_metadata(const std::filesystem::path& file);

}  // namespace spectrace
