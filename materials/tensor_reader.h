// SPDX-License-Identifier: Apache-2.0
// Fields of a tensor file, checked as they are read: what every reader of `.sep` files asks of them.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "materials/packed_table.h"
#include "materials/spectral_axis.h"
#include "materials/tensor_file.h"

namespace spectrace {

/// Each function throws InputError naming file and field where it is missing, of another type or shape (a 0
/// in `shape` matches any size), or breaks what the name of the function says.
class TensorReader {
 public:
  explicit TensorReader(const TensorFile& file) : file_(file) {}

  [[nodiscard]] bool has(std::string_view name) const { return file_.find(name) != nullptr; }
  [[nodiscard]] std::vector<float> finite(std::string_view name, std::span<const std::size_t> shape) const;
  /// Finite, and >= 0: anything else would reach pixels.
  [[nodiscard]] std::vector<float> non_negative(std::string_view name,
                                                std::span<const std::size_t> shape) const;
  [[nodiscard]] std::string text(std::string_view name) const;
  /// The text of a field that may be absent.
  [[nodiscard]] std::string optional_text(std::string_view name) const;
  /// Field "wavelengths", strictly increasing [nm]; without it the axis is RGB.
  [[nodiscard]] SpectralAxis axis() const;
  /// Field "theta_h_spacing": "quadratic" rather than "uniform".
  [[nodiscard]] bool is_quadratic() const;
  /// Integer tables of materials/packed_table.h.
  [[nodiscard]] std::vector<std::uint8_t> bytes(std::string_view name, const PlaneShape& shape) const;
  [[nodiscard]] std::vector<std::uint16_t> shorts(std::string_view name, const PlaneShape& shape) const;
  /// Rows of a field of two dimensions: the number of terms of a sum, from 1 to `largest`.
  [[nodiscard]] std::size_t rank(std::string_view name, std::size_t largest) const;
  /// Every field must be in one of the lists: an optional one under another name would be missed unnoticed.
  void refuse_unknown(std::initializer_list<std::span<const std::string_view>> known) const;
  [[noreturn]] void fail(std::string_view name, std::string problem) const;

 private:
  [[nodiscard]] const Tensor& packed(std::string_view name) const;

  const TensorFile& file_;
};

}  // namespace spectrace
