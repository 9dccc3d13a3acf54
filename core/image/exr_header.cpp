// SPDX-License-Identifier: Apache-2.0
#include "core/image/exr_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>
#include <string_view>
#include <utility>

#include "core/base/error.h"

namespace spectrace {

namespace {

constexpr std::size_t kMagicAndVersion = 8;
constexpr std::uint32_t kMultiPart = 0x1000;  // of the version field
// A pixel of the most compressible image (constant, ZIP) takes 4 / 1030 bytes a channel; a header that asks
// for more than twice that is damaged or hostile.
constexpr std::uint64_t kMaxExpansion = 2060;
constexpr std::uint64_t kFreeBytes = std::uint64_t(1) << 20;  // tiny files may be all header
/// What zlib can make of a byte: of manifests, which announce the size they unpack to.
constexpr std::uint64_t kMostExpansion = 1032;

constexpr std::uint64_t kMostPreview = 1 << 16;

/// Of what the format predefines; others are as long as they say.
constexpr std::array<std::pair<std::string_view, std::uint32_t>, 24> kSizes{{{"box2i", 16},
                                                                             {"box2f", 16},
                                                                             {"chromaticities", 32},
                                                                             {"compression", 1},
                                                                             {"deepImageState", 1},
                                                                             {"double", 8},
                                                                             {"envmap", 1},
                                                                             {"float", 4},
                                                                             {"int", 4},
                                                                             {"keycode", 28},
                                                                             {"lineOrder", 1},
                                                                             {"m33f", 36},
                                                                             {"m33d", 72},
                                                                             {"m44f", 64},
                                                                             {"m44d", 128},
                                                                             {"rational", 8},
                                                                             {"tiledesc", 9},
                                                                             {"timecode", 8},
                                                                             {"v2i", 8},
                                                                             {"v2f", 8},
                                                                             {"v2d", 16},
                                                                             {"v3i", 12},
                                                                             {"v3f", 12},
                                                                             {"v3d", 24}}};

class HeaderReader {
 public:
  HeaderReader(std::span<const std::byte> bytes, std::uint64_t file_size, const std::string& file)
      : bytes_(bytes), file_size_(file_size), file_(file) {}

  void check() {
    if (bytes_.size() < kMagicAndVersion) throw truncated();
    const bool has_parts = (number<std::uint32_t>(sizeof(std::uint32_t)) & kMultiPart) != 0;
    at_ = kMagicAndVersion;
    do {
      width_ = height_ = tile_ = channels_ = 0;
      while (byte_at(at_) != 0) check_attribute();
      check_amount(std::max<std::uint64_t>(width_ * height_, tile_));
      ++at_;
    } while (has_parts && byte_at(at_) != 0);
  }

 private:
  /// The library allocates lines and tiles when it opens a file, before anybody can ask for their size.
  void check_amount(std::uint64_t pixels) const {
    const std::uint64_t most = (file_size_ * kMaxExpansion + kFreeBytes) / sizeof(float);
    if (pixels > most || pixels * std::max<std::uint64_t>(1, channels_) > most) {
      throw InputError(
          file_, "",
          fmt::format("header announces {} x {} pixels of {} channels, more than {} bytes can hold", width_,
                      height_, channels_, file_size_));
    }
  }

  void check_attribute() {
    const std::string_view name = text();
    const std::string_view type = text();
    const auto size = number<std::uint32_t>(at_);
    const std::size_t value = at_ + sizeof size;
    if (size > file_size_ - value) {
      throw wrong(
          fmt::format("EXR attribute announces {} bytes, the file has {} left", size, file_size_ - value));
    }
    const std::optional<std::uint64_t> needed = size_of(type, value, size);
    if (needed && *needed != size) {
      throw wrong(
          fmt::format("EXR attribute of type \"{}\" announces {} bytes, it has {}", type, size, *needed));
    }
    if (name == "dataWindow" && type == "box2i") look_at_window(value);
    if (type == "tiledesc") {
      tile_ =
          std::uint64_t(number<std::uint32_t>(value)) * number<std::uint32_t>(value + sizeof(std::uint32_t));
    }
    at_ = value + size;
  }

  void look_at_window(std::size_t value) {
    const auto corner = [&](std::size_t i) {
      return std::int64_t(number<std::int32_t>(value + i * sizeof(std::int32_t)));
    };
    width_ = std::uint64_t(std::max<std::int64_t>(0, corner(2) - corner(0) + 1));
    height_ = std::uint64_t(std::max<std::int64_t>(0, corner(3) - corner(1) + 1));
  }

  /// Nothing where any size will do.
  std::optional<std::uint64_t> size_of(std::string_view type, std::size_t value, std::uint32_t size) {
    if (type == "chlist") return channel_list_size(value);
    if (type == "preview") {
      const std::uint64_t width = number<std::uint32_t>(value), height = number<std::uint32_t>(value + 4);
      if (std::max(width, height) > kMostPreview) throw wrong("EXR preview is too large");
      return 8 + 4 * width * height;
    }
    if (type == "idmanifest" && number<std::uint32_t>(value) > kMostExpansion * size) {
      throw wrong("EXR manifest announces more than it can unpack to");
    }
    const auto known =
        std::find_if(kSizes.begin(), kSizes.end(), [&](const auto& s) { return s.first == type; });
    return known == kSizes.end() ? std::nullopt : std::optional<std::uint64_t>(known->second);
  }

  /// Names that end with 0, each with 16 bytes behind; then one more 0.
  std::uint64_t channel_list_size(std::size_t value) {
    constexpr std::size_t kChannel = 16;
    const std::size_t begin = std::exchange(at_, value);
    while (byte_at(at_) != 0) {
      (void)text();
      at_ += kChannel;
      ++channels_;
    }
    const std::size_t end = std::exchange(at_, begin);
    return end + 1 - value;
  }

  /// Up to the next 0, which is passed.
  std::string_view text() {
    const auto from = bytes_.begin() + static_cast<std::ptrdiff_t>(std::min(at_, bytes_.size()));
    const auto end = std::find(from, bytes_.end(), std::byte{0});
    if (end == bytes_.end()) throw truncated();
    const std::string_view found(reinterpret_cast<const char*>(bytes_.data()) + at_, std::size_t(end - from));
    at_ += found.size() + 1;
    return found;
  }
  template <typename T>
  T number(std::size_t at) const {
    if (at > bytes_.size() || sizeof(T) > bytes_.size() - at) throw truncated();
    T x{};
    std::memcpy(&x, bytes_.data() + at, sizeof x);
    return x;
  }
  std::uint8_t byte_at(std::size_t at) const { return number<std::uint8_t>(at); }
  InputError truncated() const { return wrong("EXR header ends too early"); }
  InputError wrong(const std::string& problem) const { return {file_, fmt::format("byte {}", at_), problem}; }

  std::span<const std::byte> bytes_;
  std::uint64_t file_size_;
  const std::string& file_;
  std::size_t at_ = 0;
  std::uint64_t width_ = 0, height_ = 0, tile_ = 0, channels_ = 0;  // of the part under way
};

}  // namespace

void check_exr_attributes(std::span<const std::byte> bytes, std::uint64_t file_size,
                          const std::string& file) {
  HeaderReader(bytes, file_size, file).check();
}

}  // namespace spectrace
