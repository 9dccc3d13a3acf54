// SPDX-License-Identifier: Apache-2.0
#include "materials/merl_file.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "core/base/error.h"
#include "materials/half_difference.h"

namespace spectrace {
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr std::array<std::int32_t, 3> kDimensions{90, 90, 180};
constexpr std::size_t kHeader = sizeof(kDimensions);
/// What the stored numbers are multiplied by to give f, for red, green and blue (the database's
/// BRDFRead.cpp).
constexpr std::array kScale{1.0 / 1500, 1.15 / 1500, 1.66 / 1500};
constexpr std::array kChannel{'R', 'G', 'B'};

double number_at(std::span<const std::byte> bytes, std::size_t offset) {
  double x = 0;
  std::memcpy(&x, bytes.data() + offset, sizeof(x));
  return x;
}

}  // namespace

bool is_merl(std::span<const std::byte> bytes) {
  return bytes.size() >= kHeader && std::memcmp(bytes.data(), kDimensions.data(), kHeader) == 0;
}

MerlBrdf::MerlBrdf(std::span<const std::byte> bytes, const std::string& file_name) {
  if (!is_merl(bytes)) {
    throw InputError(
        file_name, "byte 0: field \"dims\"",
        fmt::format("expected {} x {} x {}, little endian", kDimensions[0], kDimensions[1], kDimensions[2]));
  }
  const std::size_t expected = kHeader + 3 * grid_.size() * sizeof(double);
  if (bytes.size() != expected) {
    throw InputError(file_name, fmt::format("byte {}", std::min(bytes.size(), expected)),
                     fmt::format("{} bytes, expected {}", bytes.size(), expected));
  }
  values_.resize(grid_.size());  // not before: a header alone must not cost the memory of a file
  for (std::size_t channel = 0; channel < 3; ++channel) {
    for (std::size_t i = 0; i < values_.size(); ++i) {
      const std::size_t offset = kHeader + (channel * values_.size() + i) * sizeof(double);
      const auto f = static_cast<float>(number_at(bytes, offset) * kScale[channel]);
      if (!std::isfinite(f)) {
        const std::size_t phi = std::size_t(grid_.n_phi_d), theta = std::size_t(grid_.n_theta_d);
        throw InputError(file_name, fmt::format("byte {}: field \"{}\"", offset, kChannel[channel]),
                         fmt::format("value {} at [{},{},{}], expected a finite number",
                                     number_at(bytes, offset), i / phi / theta, i / phi % theta, i % phi));
      }
      values_[i][channel] = f;
    }
  }
  for (auto& [r, g, b] : values_) {
    if (r >= 0 && g >= 0 && b >= 0) continue;
    r = g = b = -1;
    ++invalid_;
  }
}

bool MerlBrdf::read(Vec3 wo, Vec3 wi, std::span<float> value_cos) const {
  const GridPoint at = grid_.locate(to_half_difference(wo, wi));
  std::array<float, 3> sum{};
  float weight = 0;
  for (std::size_t i = 0; i < at.cell.size(); ++i) {
    const std::array<float, 3>& f = values_[at.cell[i]];
    if (f[0] < 0) continue;
    weight += at.cell_weight[i];
    for (std::size_t channel = 0; channel < 3; ++channel) sum[channel] += at.cell_weight[i] * f[channel];
  }
  const float scale = weight > 0 ? static_cast<float>(wi.z) / weight : 0;
  for (std::size_t channel = 0; channel < 3; ++channel) value_cos[channel] = sum[channel] * scale;
  return weight >= 0.5F;
}

}  // namespace spectrace
