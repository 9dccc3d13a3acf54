// SPDX-License-Identifier: Apache-2.0
// EXR through memory, never through the library's own file streams: those swallow the errors of the last
// write (a full disk) in their destructors, and name temporaries in their messages.
#include "core/image/exr.h"

#include <ImathBox.h>
#include <ImfArray.h>
#include <ImfChannelList.h>
#include <ImfDoubleAttribute.h>
#include <ImfFloatAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfIntAttribute.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <ImfVersion.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/image/exr_header.h"

namespace spectrace {

namespace {

class MemoryOut final : public Imf::OStream {
 public:
  MemoryOut() : OStream("memory") {}
  void write(const char* source, int n) override {
    const std::size_t end = position_ + static_cast<std::size_t>(n);
    if (bytes_.size() < end) bytes_.resize(end);
    std::memcpy(bytes_.data() + position_, source, static_cast<std::size_t>(n));
    position_ = end;
  }
  std::uint64_t tellp() override { return position_; }
  void seekp(std::uint64_t position) override { position_ = position; }
  [[nodiscard]] std::span<const std::byte> bytes() const { return bytes_; }

 private:
  std::vector<std::byte> bytes_;
  std::size_t position_ = 0;
};

class MemoryIn final : public Imf::IStream {
 public:
  explicit MemoryIn(std::span<const std::byte> bytes) : IStream("memory"), bytes_(bytes) {}
  bool read(char* target, int n) override {
    const std::uint64_t left = bytes_.size() - std::min<std::uint64_t>(position_, bytes_.size());
    if (n < 0 || static_cast<std::uint64_t>(n) > left) throw std::runtime_error("unexpected end of file");
    std::memcpy(target, bytes_.data() + position_, static_cast<std::size_t>(n));
    position_ += static_cast<std::uint64_t>(n);
    return position_ < bytes_.size();
  }
  std::uint64_t tellg() override { return position_; }
  void seekg(std::uint64_t position) override { position_ = position; }

 private:
  std::span<const std::byte> bytes_;
  std::uint64_t position_ = 0;
};

/// Layer by layer, the parts of colours and vectors in their usual order.
void sort_channels(std::vector<std::string>& names) {
  const auto key = [](const std::string& name) {
    const std::size_t dot = name.rfind('.');
    const std::size_t begin = dot == std::string::npos ? 0 : dot + 1;
    const std::string_view component = std::string_view(name).substr(begin);
    const std::size_t rank =
        component.size() == 1 ? std::string_view("RGBAXYZ").find(component) : std::string::npos;
    return std::tuple(name.substr(0, begin), rank, name);
  };
  std::sort(names.begin(), names.end(),
            [&](const std::string& a, const std::string& b) { return key(a) < key(b); });
}

/// The size of the image, of which check_exr_attributes() has seen that the file can hold it.
std::pair<int, int> checked_size(const Imf::Header& header, const std::string& file, std::size_t max_pixels) {
  const Imath::Box2i& window = header.dataWindow();
  const std::int64_t width = std::int64_t(window.max.x) - window.min.x + 1;
  const std::int64_t height = std::int64_t(window.max.y) - window.min.y + 1;
  std::uint64_t channels = 0;
  for (auto c = header.channels().begin(); c != header.channels().end(); ++c, ++channels) {
    if (c.channel().xSampling != 1 || c.channel().ySampling != 1) {
      throw InputError(file, "", fmt::format("channel \"{}\" is subsampled, which is not read", c.name()));
    }
  }
  if (width < 1 || height < 1 || channels == 0) throw InputError(file, "", "EXR without pixels");
  const std::uint64_t pixels =
      std::uint64_t(width) * std::uint64_t(height);  // below 2^64: both are below 2^32
  if (pixels > max_pixels) {
    throw InputError(file, "", fmt::format("{} x {} pixels, at most {} are read", width, height, max_pixels));
  }
  return {static_cast<int>(width), static_cast<int>(height)};
}

/// Runs `decode` on the opened file; whatever the library throws about it is bad input.
template <typename Decode>
auto with_exr(std::span<const std::byte> bytes, const std::string& file, Decode decode) {
  check_exr_attributes(bytes, bytes.size(), file);
  try {
    MemoryIn stream(bytes);
    Imf::InputFile in(stream);
    // Only the first would be read, and nobody would hear of the others.
    if (Imf::isMultiPart(in.version()))
      throw InputError(file, "", "has several parts; images of one part are read");
    return decode(in);
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& e) {
    throw InputError(file, "", fmt::format("damaged or unsupported EXR: {}", e.what()));
  }
}

Imf::Header make_header(const Image& image, const Metadata& metadata) {
  Imf::Header header(image.width, image.height);
  header.compression() = Imf::ZIP_COMPRESSION;
  for (const std::string& name : image.channels) header.channels().insert(name, Imf::Channel(Imf::FLOAT));
  for (const auto& [name, value] : metadata) {
    if (const auto* text = std::get_if<std::string>(&value)) {
      header.insert(name, Imf::StringAttribute(*text));
    } else if (const auto* number = std::get_if<double>(&value)) {
      header.insert(name, Imf::DoubleAttribute(*number));
    } else if (const std::int64_t integer = std::get<std::int64_t>(value); std::in_range<int>(integer)) {
      header.insert(name, Imf::IntAttribute(static_cast<int>(integer)));
    } else {
      header.insert(name, Imf::StringAttribute(std::to_string(integer)));
    }
  }
  return header;
}

/// All channels of the interleaved `data`, whose pixel (min_x, min_y) is its first.
Imf::FrameBuffer make_frame_buffer(const std::vector<std::string>& channels, const float* data, int width,
                                   int min_x, int min_y) {
  const std::size_t x_stride = channels.size() * sizeof(float);
  const std::size_t y_stride = x_stride * static_cast<std::size_t>(width);
  Imf::FrameBuffer buffer;
  // The library takes non-const memory for reading and writing alike; writing a file only reads it.
  char* base = reinterpret_cast<char*>(const_cast<float*>(data));
  const std::ptrdiff_t to_origin = -(std::ptrdiff_t(min_x) * static_cast<std::ptrdiff_t>(x_stride) +
                                     std::ptrdiff_t(min_y) * static_cast<std::ptrdiff_t>(y_stride));
  for (std::size_t c = 0; c < channels.size(); ++c) {
    buffer.insert(channels[c],
                  Imf::Slice(Imf::FLOAT, base + to_origin + c * sizeof(float), x_stride, y_stride));
  }
  return buffer;
}

}  // namespace

void write_exr(const std::filesystem::path& file, const Image& image, const Metadata& metadata) {
  SPECTRACE_CHECK(image.width > 0 && image.height > 0 && !image.channels.empty());
  SPECTRACE_CHECK(image.data.size() == std::size_t(image.width) * image.height * image.channels.size());
  MemoryOut stream;
  {
    Imf::OutputFile out(stream, make_header(image, metadata));
    out.setFrameBuffer(make_frame_buffer(image.channels, image.data.data(), image.width, 0, 0));
    out.writePixels(image.height);
  }
  write_file_atomically(file, stream.bytes());
}

bool is_exr(std::span<const std::byte> bytes) {
  constexpr std::array kMagic{std::byte{0x76}, std::byte{0x2f}, std::byte{0x31}, std::byte{0x01}};
  return bytes.size() >= kMagic.size() && std::equal(kMagic.begin(), kMagic.end(), bytes.begin());
}

void check_exr_header(const std::filesystem::path& file) {
  constexpr std::size_t kMaxHeader = std::size_t(1) << 24;
  std::error_code failed;
  const std::uint64_t size = std::filesystem::file_size(file, failed);
  if (failed) throw InputError(file.string(), "", fmt::format("cannot be read: {}", failed.message()));
  std::vector<std::byte> head(std::size_t(std::min<std::uint64_t>(size, kMaxHeader)));
  std::ifstream stream(file, std::ios::binary);
  if (!stream.read(reinterpret_cast<char*>(head.data()), std::streamsize(head.size()))) {
    throw InputError(file.string(), "", "cannot be read");
  }
  if (is_exr(head)) check_exr_attributes(head, size, file.string());
}

Image decode_exr(std::span<const std::byte> bytes, const std::string& file, std::size_t max_pixels) {
  return with_exr(bytes, file, [&](Imf::InputFile& in) {
    const Imf::Header& header = in.header();
    const auto [width, height] = checked_size(header, file, max_pixels);
    std::vector<std::string> names;
    for (auto c = header.channels().begin(); c != header.channels().end(); ++c) names.emplace_back(c.name());
    sort_channels(names);
    Image image(width, height, std::move(names));
    const Imath::Box2i& window = header.dataWindow();
    in.setFrameBuffer(
        make_frame_buffer(image.channels, image.data.data(), width, window.min.x, window.min.y));
    in.readPixels(window.min.y, window.max.y);
    return image;
  });
}

Metadata decode_exr_metadata(std::span<const std::byte> bytes, const std::string& file) {
  constexpr std::array<std::string_view, 6> kLayout = {"pixelAspectRatio", "screenWindowWidth", "type",
                                                       "version",          "chunkCount",        "name"};
  return with_exr(bytes, file, [&](Imf::InputFile& in) {
    Metadata metadata;
    for (auto it = in.header().begin(); it != in.header().end(); ++it) {
      if (std::find(kLayout.begin(), kLayout.end(), std::string_view(it.name())) != kLayout.end()) continue;
      const Imf::Attribute* attribute = &it.attribute();
      if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(attribute)) {
        metadata[it.name()] = text->value();
      } else if (const auto* real = dynamic_cast<const Imf::DoubleAttribute*>(attribute)) {
        metadata[it.name()] = real->value();
      } else if (const auto* single = dynamic_cast<const Imf::FloatAttribute*>(attribute)) {
        metadata[it.name()] = static_cast<double>(single->value());
      } else if (const auto* integer = dynamic_cast<const Imf::IntAttribute*>(attribute)) {
        metadata[it.name()] = std::int64_t(integer->value());
      }
    }
    return metadata;
  });
}

}  // namespace spectrace
