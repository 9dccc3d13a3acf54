// SPDX-License-Identifier: Apache-2.0
// Images of every format but EXR, through OpenImageIO.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <OpenImageIO/strutil.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/image/exr.h"
#include "core/image/image.h"
#include "core/spectra/color.h"

namespace spectrace {

namespace {

constexpr int kMaxChannels = 1024;
constexpr const char* kJpegQuality = "jpeg:90";  // no difference to be seen at arm's length

std::unique_ptr<OIIO::ImageInput> open_image(const std::filesystem::path& file) {
  OIIO::ImageSpec config;
  config.attribute("oiio:UnassociatedAlpha", 1);  // colours as stored, not multiplied by alpha
  auto in = OIIO::ImageInput::open(file.string(), &config);
  if (!in) {
    throw InputError(file.string(), "", fmt::format("cannot be read as an image: {}", OIIO::geterror()));
  }
  return in;
}

void check_size(const OIIO::ImageSpec& spec, const std::string& file, std::size_t max_pixels) {
  if (spec.width < 1 || spec.height < 1 || spec.depth > 1 || spec.nchannels < 1 ||
      spec.nchannels > kMaxChannels) {
    throw InputError(file, "",
                     fmt::format("{} x {} x {} pixels of {} channels are not read", spec.width, spec.height,
                                 spec.depth, spec.nchannels));
  }
  if (std::size_t(spec.width) * std::size_t(spec.height) > max_pixels) {
    throw InputError(file, "",
                     fmt::format("{} x {} pixels, at most {} are read", spec.width, spec.height, max_pixels));
  }
}

/// "R", "G", "B" and "A" whatever the format calls them; grey becomes three equal channels.
Image with_rgb(Image image) {
  const std::size_t n = image.channels.size();
  if (n >= 3) return image;
  Image rgb(image.width, image.height, {"R", "G", "B"});
  if (n == 2) rgb = Image(image.width, image.height, {"R", "G", "B", "A"});
  const std::size_t m = rgb.channels.size();
  for (std::size_t i = 0; i < std::size_t(image.width) * std::size_t(image.height); ++i) {
    for (std::size_t c = 0; c < m; ++c) rgb.data[i * m + c] = image.data[i * n + (c == 3 ? 1 : 0)];
  }
  return rgb;
}

void decode_srgb(Image& image, int alpha_channel) {
  const std::size_t n = image.channels.size();
  for (std::size_t i = 0; i < image.data.size(); ++i) {
    if (static_cast<int>(i % n) == alpha_channel) continue;
    image.data[i] = static_cast<float>(srgb_decode(image.data[i]));
  }
}

std::vector<unsigned char> encode_8bit(const Image& rgb, double exposure) {
  std::vector<unsigned char> pixels(rgb.data.size());
  for (std::size_t i = 0; i < pixels.size(); i += 3) {
    const float* source = &rgb.data[i];
    if (!std::all_of(source, source + 3, [](float x) { return std::isfinite(x); })) {
      pixels[i] = pixels[i + 2] = 255;
      pixels[i + 1] = 0;
      continue;
    }
    for (std::size_t c = 0; c < 3; ++c) {
      const double encoded = srgb_encode(std::clamp(source[c] * exposure, 0.0, 1.0));
      pixels[i + c] = static_cast<unsigned char>(std::lround(255 * encoded));
    }
  }
  return pixels;
}

}  // namespace

Image read_image(const std::filesystem::path& file, std::size_t max_pixels) {
  const std::string name = file.string();
  {
    const std::vector<std::byte> bytes = read_file(file);
    if (is_exr(bytes)) return decode_exr(bytes, name, max_pixels);
  }
  const auto in = open_image(file);
  const OIIO::ImageSpec spec = in->spec();
  check_size(spec, name, max_pixels);
  Image image(spec.width, spec.height, spec.channelnames);
  if (!in->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, image.data.data())) {
    throw InputError(name, "", fmt::format("damaged image: {}", in->geterror()));
  }
  const bool is_integer = !spec.format.is_floating_point();
  if (is_integer && !OIIO::Strutil::iequals(spec.get_string_attribute("oiio:ColorSpace"), "linear"))
    decode_srgb(image, spec.alpha_channel);
  return with_rgb(std::move(image));
}

Metadata read_metadata(const std::filesystem::path& file) {
  {
    const std::vector<std::byte> bytes = read_file(file);
    if (is_exr(bytes)) return decode_exr_metadata(bytes, file.string());
  }
  const auto in = open_image(file);
  Metadata metadata;
  for (const OIIO::ParamValue& attribute : in->spec().extra_attribs) {
    const std::string key = attribute.name().string();
    const bool is_single =
        attribute.type().numelements() == 1 && attribute.type().aggregate == OIIO::TypeDesc::SCALAR;
    if (attribute.type() == OIIO::TypeDesc::STRING) {
      metadata[key] = attribute.get_string();
    } else if (is_single && attribute.type().is_floating_point()) {
      metadata[key] = static_cast<double>(attribute.get_float());
    } else if (is_single) {
      metadata[key] = std::int64_t(attribute.get_int());
    }
  }
  return metadata;
}

namespace {

/// 8-bit sRGB in OpenImageIO's `format`, in memory: what a full disk does is then told by our own writing.
std::vector<unsigned char> encode(const std::string& format, const Image& image, std::string_view layer,
                                  double exposure, const std::string& file) {
  const Image rgb = image.select(rgb_channels(layer), file);
  const std::vector<unsigned char> pixels = encode_8bit(rgb, exposure);
  std::vector<unsigned char> encoded;
  OIIO::Filesystem::IOVecOutput memory(encoded);
  OIIO::ImageSpec spec(rgb.width, rgb.height, 3, OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:ColorSpace", "sRGB");
  if (format == "jpeg") spec.attribute("Compression", kJpegQuality);
  const auto out = OIIO::ImageOutput::create(format, &memory);
  const bool written = out && out->open("memory." + format, spec) &&
                       out->write_image(OIIO::TypeDesc::UINT8, pixels.data()) && out->close();
  if (!written) {
    throw InputError(file, "",
                     fmt::format("cannot encode {}: {}", format, out ? out->geterror() : OIIO::geterror()));
  }
  return encoded;
}

std::string data_uri(const std::string& format, const Image& image, std::string_view layer, double exposure) {
  const std::vector<unsigned char> encoded = encode(format, image, layer, exposure, "page");
  const OIIO::string_view bytes(reinterpret_cast<const char*>(encoded.data()), encoded.size());
  return fmt::format("data:image/{};base64,{}", format, OIIO::Strutil::base64_encode(bytes));
}

}  // namespace

void write_png(const std::filesystem::path& file, const Image& image, std::string_view layer,
               double exposure) {
  const std::vector<unsigned char> encoded = encode("png", image, layer, exposure, file.string());
  write_file_atomically(file, std::as_bytes(std::span(encoded)));
}

std::string png_data_uri(const Image& image, std::string_view layer, double exposure) {
  return data_uri("png", image, layer, exposure);
}

std::string jpeg_data_uri(const Image& image, std::string_view layer, double exposure) {
  return data_uri("jpeg", image, layer, exposure);
}

}  // namespace spectrace
