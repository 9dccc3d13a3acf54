// SPDX-License-Identifier: Apache-2.0
#include "core/image/tev_packets.h"

#include <algorithm>

namespace spectrace {

namespace {

static_assert(std::endian::native == std::endian::little, "packets are written as numbers lie in memory");

enum class PacketType : std::uint8_t { kCreateImage = 4, kUpdateImageV3 = 6 };

class Packet {
 public:
  explicit Packet(PacketType type) {
    put(std::uint32_t(0));  // the length, known at the end
    put(type);
    put(std::uint8_t(0));  // no focus: a viewer who looks at another picture goes on doing so
  }
  template <typename T>
  void put(const T& x) {
    const auto bytes = std::as_bytes(std::span(&x, 1));
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
  }
  void put_text(const std::string& text) {
    const auto bytes = std::as_bytes(std::span(text.c_str(), text.size() + 1));
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
  }
  void put_floats(std::span<const float> values) {
    const auto bytes = std::as_bytes(values);
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
  }
  [[nodiscard]] std::vector<std::byte> finished() {
    const auto length = static_cast<std::uint32_t>(bytes_.size());
    std::memcpy(bytes_.data(), &length, sizeof length);
    return std::move(bytes_);
  }

 private:
  std::vector<std::byte> bytes_;
};

bool same_tile(const Image& a, const Image& b, const TevTile& tile) {
  const std::size_t row_bytes = std::size_t(tile.width) * a.channels.size() * sizeof(float);
  for (int y = tile.y; y < tile.y + tile.height; ++y) {
    const std::size_t first = a.index(tile.x, y, 0);
    if (std::memcmp(&a.data[first], &b.data[first], row_bytes) != 0) return false;
  }
  return true;
}

}  // namespace

std::vector<std::byte> tev_create(const std::string& name, const Image& image) {
  Packet packet(PacketType::kCreateImage);
  packet.put_text(name);
  packet.put(std::int32_t(image.width));
  packet.put(std::int32_t(image.height));
  packet.put(static_cast<std::int32_t>(image.channels.size()));
  for (const std::string& channel : image.channels) packet.put_text(channel);
  return packet.finished();
}

std::vector<std::byte> tev_update(const std::string& name, const Image& image, const TevTile& tile) {
  const std::size_t channels = image.channels.size();
  Packet packet(PacketType::kUpdateImageV3);
  packet.put_text(name);
  packet.put(static_cast<std::int32_t>(channels));
  for (const std::string& channel : image.channels) packet.put_text(channel);
  for (const int x : {tile.x, tile.y, tile.width, tile.height}) packet.put(std::int32_t(x));
  for (std::size_t c = 0; c < channels; ++c) packet.put(static_cast<std::int64_t>(c));         // offsets
  for (std::size_t c = 0; c < channels; ++c) packet.put(static_cast<std::int64_t>(channels));  // strides
  for (int y = tile.y; y < tile.y + tile.height; ++y) {
    packet.put_floats({&image.data[image.index(tile.x, y, 0)], std::size_t(tile.width) * channels});
  }
  return packet.finished();
}

std::vector<TevTile> changed_tiles(const Image& image, const Image& before) {
  const bool is_other =
      image.width != before.width || image.height != before.height || image.channels != before.channels;
  std::vector<TevTile> tiles;
  for (int y = 0; y < image.height; y += kTevTile) {
    for (int x = 0; x < image.width; x += kTevTile) {
      const TevTile tile{x, y, std::min(kTevTile, image.width - x), std::min(kTevTile, image.height - y)};
      if (is_other || !same_tile(image, before, tile)) tiles.push_back(tile);
    }
  }
  return tiles;
}

}  // namespace spectrace
