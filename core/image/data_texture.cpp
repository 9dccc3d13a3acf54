// SPDX-License-Identifier: Apache-2.0
#include "core/image/data_texture.h"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "core/base/error.h"
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

/// `fallback`, and the problem recorded, where the file cannot be read.
template <typename T, typename Read>
T read_for(const JsonValue& json, const T& fallback, const Read& read) {
  const std::filesystem::path file = json.path();
  if (json.is_string() && file.filename().empty()) {
    json.error("expected the name of a file, got an empty string");
    return fallback;
  }
  if (file.empty()) return fallback;
  if (std::error_code failed; !std::filesystem::is_regular_file(file, failed)) {
    json.error("there is no file \"" + file.lexically_normal().string() + '"');
    return fallback;
  }
  try {
    return read(file);
  } catch (const InputError& e) {
    json.error(e.diagnostics().front().text());
    return fallback;
  }
}

}  // namespace

Float ScalarTexture::at(Vec2 uv, const Footprint& over) const {
  if (const auto* constant = std::get_if<Float>(&v_)) return *constant;
  if (const auto* board = std::get_if<ScalarCheckerboard>(&v_)) {
    const Float cells = std::floor(uv.x * board->repeat.x) + std::floor(uv.y * board->repeat.y);
    return std::fmod(cells, Float(2)) != 0 ? board->odd : board->even;
  }
  float value = 0;
  std::get<CachedImage>(v_).mean(uv, over, 0, 1, &value);
  return Float(value);
}

Float ScalarTexture::mean() const {
  if (const auto* board = std::get_if<ScalarCheckerboard>(&v_)) return (board->even + board->odd) / 2;
  return at({Float(0.5), Float(0.5)}, kWholeFootprint);
}

NormalTexture::NormalTexture(CachedImage bitmap) : bitmap_(std::move(bitmap)) {
  SPECTRACE_CHECK(bitmap_->channels() == 3);
}

Vec3 NormalTexture::at(Vec2 uv, const Footprint& over) const {
  if (!bitmap_) return {0, 0, 1};
  std::array<float, 3> rgb{};
  bitmap_->mean(uv, over, 0, 3, rgb.data());
  const Vec3 n{2 * Float(rgb[0]) - 1, 2 * Float(rgb[1]) - 1, 2 * Float(rgb[2]) - 1};
  return n.z > 0 ? normalize(n) : Vec3{0, 0, 1};
}

ScalarTexture scalar_bitmap(const std::filesystem::path& file) {
  const std::vector<std::string> names = texel_channels(file);
  const bool has_alpha = std::find(names.begin(), names.end(), "A") != names.end();
  return ScalarTexture(CachedImage(file, {has_alpha ? "A" : names.front()}, TexelCoding::kData));
}

NormalTexture normal_bitmap(const std::filesystem::path& file) {
  return NormalTexture(CachedImage(file, {"R", "G", "B"}, TexelCoding::kData));
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
  return board.exists() ? parse_checkerboard(board) : read_for(bitmap, ScalarTexture(), scalar_bitmap);
}

NormalTexture parse_normal_texture(const JsonValue& json) {
  return read_for(json, NormalTexture(), normal_bitmap);
}

}  // namespace spectrace
