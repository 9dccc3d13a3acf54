// SPDX-License-Identifier: Apache-2.0
// The tensor container of the EPFL BRDF database (docs/file-formats.md), also that of our `.sep` files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace spectrace {

enum class TensorType : std::uint8_t {
  kU8 = 1,
  kI8,
  kU16,
  kI16,
  kU32,
  kI32,
  kU64,
  kI64,
  kF16,
  kF32,
  kF64,
};
[[nodiscard]] std::size_t size_of(TensorType type);
[[nodiscard]] std::string_view name_of(TensorType type);  ///< "f32"

struct Tensor {
  std::string name;
  TensorType type = TensorType::kF32;
  std::vector<std::size_t> shape;
  std::vector<std::byte> bytes;  ///< row major, little endian
  std::uint64_t offset = 0;      ///< in the file it came from, for messages

  [[nodiscard]] std::size_t count() const;
  [[nodiscard]] std::string shape_text() const;  ///< "[1,8,32,32]"
  /// Converted from f16, f32 or f64; any other type is a programmer's error.
  [[nodiscard]] std::vector<float> floats() const;
  static Tensor from_floats(std::string name, std::vector<std::size_t> shape, std::span<const float> values);
  static Tensor from_text(std::string name, std::string_view text);  ///< u8
};

class TensorFile {
 public:
  /// Throws InputError naming the byte offset and field: wrong magic (other programs' .bsdf are told
  /// apart by name: Zemax, LightTools, Radiance, XML), truncated or overlapping fields, bytes of no field
  /// that are no padding, unknown types, sizes that overflow or exceed the file. Memory is bounded by the
  /// file's size.
  static TensorFile read(const std::filesystem::path& file);
  static TensorFile parse(std::span<const std::byte> bytes, std::string file_name);
  /// True where the bytes begin like a tensor file.
  static bool has_magic(std::span<const std::byte> bytes);

  [[nodiscard]] const std::string& file_name() const { return file_name_; }
  [[nodiscard]] const std::vector<Tensor>& tensors() const { return tensors_; }
  [[nodiscard]] const Tensor* find(std::string_view name) const;
  /// Throws InputError where the field is missing, of another type or shape; a 0 in `shape` matches any size.
  [[nodiscard]] const Tensor& require(std::string_view name, std::span<const TensorType> types,
                                      std::span<const std::size_t> shape) const;

  void add(Tensor tensor);  ///< the name must be new
  [[nodiscard]] std::vector<std::byte> serialize() const;
  void write(const std::filesystem::path& file) const;  ///< aside and renamed

 private:
  std::string file_name_;
  std::vector<Tensor> tensors_;
};

}  // namespace spectrace
