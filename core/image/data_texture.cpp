// SPDX-License-Identifier: Apache-2.0
#include "core/image/data_texture.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string>

#include "core/base/error.h"
#include "core/image/bilinear.h"
#include "core/math/math.h"

namespace spectrace {

namespace {

constexpr NumberRange kRepeatRange{.min = 0, .max = 1e6, .min_open = true};

ScalarTexture parse_checkerboard(const JsonValue& json) {
  ScalarCheckerboard board;
  board.even = static_cast<Float>(json.require("even").number(board.even, kUnitInterval));
  board.odd = static_cast<Float>(json.require("odd").number(board.odd, kUnitInterval));
  if (const std::vector<double> repeat = json.get("repeat").numbers(2, 2, kRepeatRange); !repeat.empty()) {
    board.repeat = {static_cast<Float>(repeat[0]), static_cast<Float>(repeat[1])};
  }
  json.reject_unknown_keys();
  return board;
}

/// Nothing where the file cannot be read; that is recorded.
std::optional<Image> read_for(const JsonValue& json) {
  const std::filesystem::path file = json.path();
  if (json.is_string() && file.filename().empty()) {
    json.error("expected the name of a file, got an empty string");
    return std::nullopt;
  }
  if (file.empty()) return std::nullopt;
  if (std::error_code failed; !std::filesystem::is_regular_file(file, failed)) {
    json.error("there is no file \"" + file.lexically_normal().string() + '"');
    return std::nullopt;
  }
  try {
    return read_data_image(file);
  } catch (const InputError& e) {
    json.error(e.diagnostics().front().text());
    return std::nullopt;
  }
}

ScalarTexture parse_bitmap(const JsonValue& json) {
  const std::optional<Image> image = read_for(json);
  if (!image) return {};
  const std::array<std::string, 1> channel{image->find_channel("A") ? "A" : image->channels.front()};
  return ScalarTexture(DataBitmap(image->select(channel, json.string())));
}

}  // namespace

DataBitmap::DataBitmap(const Image& image)
    : width_(image.width), height_(image.height), channels_(image.channels.size()) {
  SPECTRACE_CHECK(width_ > 0 && height_ > 0 && channels_ > 0);
  std::vector<float> texels = image.data;
  for (float& x : texels) x = x > 0 ? std::min(x, 1.0f) : 0.0f;  // NaN becomes 0
  texels_ = std::make_shared<const std::vector<float>>(std::move(texels));
}

Float DataBitmap::at(Vec2 uv, std::size_t channel) const {
  return static_cast<Float>(Bilinear(uv, width_, height_).mean([&](std::size_t row, std::size_t column) {
    return double((*texels_)[(row * static_cast<std::size_t>(width_) + column) * channels_ + channel]);
  }));
}

Float ScalarTexture::at(Vec2 uv) const {
  if (const auto* constant = std::get_if<Float>(&v_)) return *constant;
  if (const auto* board = std::get_if<ScalarCheckerboard>(&v_)) {
    const Float cells = std::floor(uv.x * board->repeat.x) + std::floor(uv.y * board->repeat.y);
    return std::fmod(cells, Float(2)) != 0 ? board->odd : board->even;
  }
  return std::get<DataBitmap>(v_).at(uv, 0);
}

DataBitmap NormalTexture::flat() {
  Image image(1, 1, {"R", "G", "B"});
  image.data = {0.5F, 0.5F, 1};
  return DataBitmap(image);
}

Vec3 NormalTexture::at(Vec2 uv) const {
  const Vec3 n{2 * bitmap_.at(uv, 0) - 1, 2 * bitmap_.at(uv, 1) - 1, 2 * bitmap_.at(uv, 2) - 1};
  return n.z > 0 ? normalize(n) : Vec3{0, 0, 1};
}

ScalarTexture parse_scalar_texture(const JsonValue& json) {
  if (!json.is_object()) return static_cast<Float>(json.number(1, kUnitInterval));
  const JsonValue board = json.get("checkerboard"), bitmap = json.get("bitmap");
  json.reject_unknown_keys();
  if (board.exists() && bitmap.exists()) bitmap.error("\"checkerboard\" already gives the texture");
  if (!board.exists() && !bitmap.exists()) {
    json.error("expected a number, \"checkerboard\" or \"bitmap\"");
    return {};
  }
  return board.exists() ? parse_checkerboard(board) : parse_bitmap(bitmap);
}

NormalTexture parse_normal_texture(const JsonValue& json) {
  const std::optional<Image> image = read_for(json);
  if (!image) return {};
  try {
    const std::array<std::string, 3> rgb{"R", "G", "B"};
    return NormalTexture(DataBitmap(image->select(rgb, json.string())));
  } catch (const InputError& e) {
    json.error(e.diagnostics().front().text());
    return {};
  }
}

}  // namespace spectrace
