// SPDX-License-Identifier: Apache-2.0
#include "materials/tensor_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

#include "core/base/error.h"
#include "core/base/nearest.h"

namespace spectrace {
namespace {

constexpr const char* kDamaged = "damaged, or not of the shape that the other fields say";

std::string text_of(const Tensor& tensor) {
  std::string text(tensor.bytes.size(), '\0');
  std::transform(tensor.bytes.begin(), tensor.bytes.end(), text.begin(),
                 [](std::byte b) { return static_cast<char>(b); });
  return text;
}

}  // namespace

std::vector<float> TensorReader::finite(std::string_view name, std::span<const std::size_t> shape) const {
  constexpr std::array kTypes{TensorType::kF32};
  std::vector<float> values = file_.require(name, kTypes, shape).floats();
  const auto bad = std::find_if(values.begin(), values.end(), [](float x) { return !std::isfinite(x); });
  if (bad != values.end()) {
    fail(name, fmt::format("expected finite values, element {} is {}", bad - values.begin(), *bad));
  }
  return values;
}

std::vector<float> TensorReader::non_negative(std::string_view name,
                                              std::span<const std::size_t> shape) const {
  constexpr std::array kTypes{TensorType::kF32};
  std::vector<float> values = file_.require(name, kTypes, shape).floats();
  const auto bad =
      std::find_if(values.begin(), values.end(), [](float x) { return !std::isfinite(x) || x < 0; });
  if (bad != values.end()) {
    fail(name, fmt::format("expected finite values >= 0, element {} is {}", bad - values.begin(), *bad));
  }
  return values;
}

std::string TensorReader::text(std::string_view name) const {
  constexpr std::array kTypes{TensorType::kU8};
  constexpr std::array<std::size_t, 1> kAnyLength{0};
  return text_of(file_.require(name, kTypes, kAnyLength));
}

std::string TensorReader::optional_text(std::string_view name) const {
  return has(name) ? text(name) : std::string();
}

SpectralAxis TensorReader::axis() const {
  if (!has("wavelengths")) return SpectralAxis::rgb();
  constexpr std::array<std::size_t, 1> kAnyLength{0};
  std::vector<float> lambda_nm = non_negative("wavelengths", kAnyLength);
  if (lambda_nm.empty()) fail("wavelengths", "expected at least one wavelength");
  if (std::adjacent_find(lambda_nm.begin(), lambda_nm.end(), std::greater_equal<>()) != lambda_nm.end()) {
    fail("wavelengths", "expected strictly increasing wavelengths");
  }
  return SpectralAxis::wavelengths(std::move(lambda_nm));
}

bool TensorReader::is_quadratic() const {
  const std::string spacing = text("theta_h_spacing");
  if (spacing != "quadratic" && spacing != "uniform") {
    fail("theta_h_spacing", "expected \"quadratic\" or \"uniform\"");
  }
  return spacing == "quadratic";
}

const Tensor& TensorReader::packed(std::string_view name) const {
  constexpr std::array kTypes{TensorType::kU8};
  constexpr std::array<std::size_t, 1> kAnyLength{0};
  return file_.require(name, kTypes, kAnyLength);
}

std::vector<std::uint8_t> TensorReader::bytes(std::string_view name, const PlaneShape& shape) const {
  auto table = unpack_u8(packed(name), shape);
  if (!table) fail(name, kDamaged);
  return *std::move(table);
}

std::vector<std::uint16_t> TensorReader::shorts(std::string_view name, const PlaneShape& shape) const {
  auto table = unpack_u16(packed(name), shape);
  if (!table) fail(name, kDamaged);
  return *std::move(table);
}

std::size_t TensorReader::rank(std::string_view name, std::size_t largest) const {
  constexpr std::array kTypes{TensorType::kF32};
  constexpr std::array<std::size_t, 2> kAnyTable{0, 0};
  const std::size_t rank = file_.require(name, kTypes, kAnyTable).shape[0];
  if (rank < 1 || rank > largest) {
    fail(name, fmt::format("has {} terms, expected 1 to {}", rank, largest));
  }
  return rank;
}

void TensorReader::refuse_unknown(std::initializer_list<std::span<const std::string_view>> known) const {
  std::vector<std::string> names;
  for (const auto& list : known) names.insert(names.end(), list.begin(), list.end());
  for (const Tensor& tensor : file_.tensors()) {
    if (std::find(names.begin(), names.end(), tensor.name) == names.end()) {
      fail(tensor.name, "is no field of a separated material" + suggestion(tensor.name, names));
    }
  }
}

void TensorReader::fail(std::string_view name, std::string problem) const {
  throw InputError(file_.file_name(), fmt::format("field \"{}\"", name), std::move(problem));
}

}  // namespace spectrace
