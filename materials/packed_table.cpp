// SPDX-License-Identifier: Apache-2.0
#include "materials/packed_table.h"

#include <zstd.h>

#include <algorithm>
#include <cstddef>
#include <limits>

#include "core/base/error.h"

namespace spectrace {
namespace {

// Level 12 comes within 2 % of the size of level 19 in a tenth of its time (measured on epfl_rgb).
constexpr int kLevel = 12;

// Of a frame's bytes: a block of 128 KiB takes at least 3 bytes of header and one of content (RFC
// 8878, 3.1.1.2).
constexpr std::size_t kMostExpansion = (std::size_t(1) << 17) / 4;

/// The gradient a plane through three neighbours would continue, clipped to their range: the median predictor
/// of Weinberger, Seroussi & Sapiro 2000 (LOCO-I).
int predict(int left, int above, int above_left) {
  return std::clamp(left + above - above_left, std::min(left, above), std::max(left, above));
}

/// Calls `visit(index, prediction)` in storage order; `values` up to the index are known by then.
template <typename T, typename F>
void for_each_prediction(const std::vector<T>& values, const PlaneShape& shape, const F& visit) {
  std::size_t i = 0;
  for (std::size_t plane = 0; plane < shape.planes; ++plane) {
    for (std::size_t y = 0; y < shape.rows; ++y) {
      for (std::size_t x = 0; x < shape.columns; ++x, ++i) {
        const int left = x > 0 ? int(values[i - 1]) : 0;
        const int above = y > 0 ? int(values[i - shape.columns]) : left;
        const int above_left = x > 0 && y > 0 ? int(values[i - shape.columns - 1]) : above;
        visit(i, static_cast<T>(x > 0 ? predict(left, above, above_left) : above));
      }
    }
  }
}

/// 0, -1, 1, -2 ... to 0, 1, 2, 3 ...: small errors of either sign share their leading zeros.
template <typename T>
T fold_sign(T difference) {
  constexpr int kTop = std::numeric_limits<T>::digits - 1;
  return static_cast<T>((difference << 1) ^ (difference >> kTop ? std::numeric_limits<T>::max() : 0));
}
template <typename T>
T unfold_sign(T folded) {
  return static_cast<T>((folded >> 1) ^ (folded & 1 ? std::numeric_limits<T>::max() : 0));
}

template <typename T>
Tensor pack_table(std::string name, std::span<const T> values, const PlaneShape& shape) {
  SPECTRACE_CHECK(values.size() == shape.size());
  const std::vector<T> table(values.begin(), values.end());
  std::vector<std::uint8_t> bytes(table.size() * sizeof(T));
  for_each_prediction(table, shape, [&](std::size_t i, T prediction) {
    const T folded = fold_sign(static_cast<T>(table[i] - prediction));
    for (std::size_t b = 0; b < sizeof(T); ++b) {
      bytes[b * table.size() + i] = static_cast<std::uint8_t>(folded >> (8 * b));
    }
  });
  Tensor tensor{.name = std::move(name), .type = TensorType::kU8, .shape = {}, .bytes = {}};
  tensor.bytes.resize(ZSTD_compressBound(bytes.size()));
  const std::size_t size =
      ZSTD_compress(tensor.bytes.data(), tensor.bytes.size(), bytes.data(), bytes.size(), kLevel);
  SPECTRACE_CHECK(!ZSTD_isError(size));
  tensor.bytes.resize(size);
  tensor.shape = {size};
  return tensor;
}

template <typename T>
std::optional<std::vector<T>> unpack_table(const Tensor& tensor, const PlaneShape& shape) {
  const std::size_t size = shape.size() * sizeof(T);
  if (ZSTD_getFrameContentSize(tensor.bytes.data(), tensor.bytes.size()) != size) return std::nullopt;
  // What the frame's header promises may be more than the machine holds: not before it can be true.
  if (size / kMostExpansion > tensor.bytes.size()) return std::nullopt;
  std::vector<std::uint8_t> bytes(size);
  if (ZSTD_decompress(bytes.data(), size, tensor.bytes.data(), tensor.bytes.size()) != size) {
    return std::nullopt;
  }
  std::vector<T> table(shape.size());
  for_each_prediction(table, shape, [&](std::size_t i, T prediction) {
    T folded = 0;
    for (std::size_t b = 0; b < sizeof(T); ++b) {
      folded = static_cast<T>(folded | (T(bytes[b * table.size() + i]) << (8 * b)));
    }
    table[i] = static_cast<T>(unfold_sign(folded) + prediction);
  });
  return table;
}

}  // namespace

Tensor pack(std::string name, std::span<const std::uint8_t> values, const PlaneShape& shape) {
  return pack_table(std::move(name), values, shape);
}
Tensor pack(std::string name, std::span<const std::uint16_t> values, const PlaneShape& shape) {
  return pack_table(std::move(name), values, shape);
}
std::optional<std::vector<std::uint8_t>> unpack_u8(const Tensor& tensor, const PlaneShape& shape) {
  return unpack_table<std::uint8_t>(tensor, shape);
}
std::optional<std::vector<std::uint16_t>> unpack_u16(const Tensor& tensor, const PlaneShape& shape) {
  return unpack_table<std::uint16_t>(tensor, shape);
}

}  // namespace spectrace
