// SPDX-License-Identifier: Apache-2.0
// One field of a tensor file: sizes and conversions. The file itself: tensor_file.cpp.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "core/base/error.h"
#include "materials/tensor_file.h"

namespace spectrace {
namespace {

/// IEEE 754 binary16.
float half_to_float(std::uint16_t half) {
  const int exponent = (half >> 10) & 0x1f;
  const int mantissa = half & 0x3ff;
  float magnitude = 0;
  if (exponent == 0x1f) {
    magnitude =
        mantissa != 0 ? std::numeric_limits<float>::quiet_NaN() : std::numeric_limits<float>::infinity();
  } else if (exponent == 0) {
    magnitude = std::ldexp(static_cast<float>(mantissa), -24);
  } else {
    magnitude = std::ldexp(static_cast<float>(mantissa + 0x400), exponent - 25);
  }
  return (half & 0x8000) != 0 ? -magnitude : magnitude;
}

template <typename T, typename Convert>
std::vector<float> convert(std::span<const std::byte> bytes, Convert to_float) {
  std::vector<float> out(bytes.size() / sizeof(T));
  for (std::size_t i = 0; i < out.size(); ++i) {
    T value;
    std::memcpy(&value, bytes.data() + i * sizeof(T), sizeof(T));
    out[i] = to_float(value);
  }
  return out;
}

}  // namespace

std::size_t size_of(TensorType type) {
  switch (type) {
    case TensorType::kU8:
    case TensorType::kI8:
      return 1;
    case TensorType::kU16:
    case TensorType::kI16:
    case TensorType::kF16:
      return 2;
    case TensorType::kU32:
    case TensorType::kI32:
    case TensorType::kF32:
      return 4;
    case TensorType::kU64:
    case TensorType::kI64:
    case TensorType::kF64:
      return 8;
  }
  throw InternalError("unknown tensor type");
}

std::string_view name_of(TensorType type) {
  constexpr std::array<std::string_view, 11> kNames{"u8",  "i8",  "u16", "i16", "u32", "i32",
                                                    "u64", "i64", "f16", "f32", "f64"};
  return kNames.at(static_cast<std::size_t>(type) - 1);
}

std::size_t Tensor::count() const {
  std::size_t n = 1;
  for (const std::size_t extent : shape) n *= extent;
  return n;
}

std::string Tensor::shape_text() const { return fmt::format("[{}]", fmt::join(shape, ",")); }

std::vector<float> Tensor::floats() const {
  if (type == TensorType::kF32) return convert<float>(bytes, [](float x) { return x; });
  if (type == TensorType::kF64) return convert<double>(bytes, [](double x) { return static_cast<float>(x); });
  SPECTRACE_CHECK(type == TensorType::kF16);
  return convert<std::uint16_t>(bytes, half_to_float);
}

Tensor Tensor::from_floats(std::string name, std::vector<std::size_t> shape, std::span<const float> values) {
  Tensor tensor{.name = std::move(name), .type = TensorType::kF32, .shape = std::move(shape), .bytes = {}};
  SPECTRACE_CHECK(tensor.count() == values.size());
  const auto raw = std::as_bytes(values);
  tensor.bytes.assign(raw.begin(), raw.end());
  return tensor;
}

Tensor Tensor::from_text(std::string name, std::string_view text) {
  Tensor tensor{.name = std::move(name), .type = TensorType::kU8, .shape = {text.size()}, .bytes = {}};
  const auto raw = std::as_bytes(std::span(text));
  tensor.bytes.assign(raw.begin(), raw.end());
  return tensor;
}

}  // namespace spectrace
