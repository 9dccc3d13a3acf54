// SPDX-License-Identifier: Apache-2.0
// Generator matrices of the Sobol' sequence.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace spectrace {

inline constexpr int kSobolBits = 32;

/// Where the columns of one dimension's matrix begin: a primitive polynomial over the integers mod 2, highest
/// power first, its end terms included, and as many odd numbers as its degree (Bratley & Fox 1988).
struct SobolStart {
  std::uint32_t polynomial = 1;
  std::array<std::uint32_t, 7> odd{};
};

/// Those of Joe & Kuo 2008 ("Constructing Sobol' sequences with better two-dimensional projections",
/// new-joe-kuo-6), from its second dimension on; the first is the radical inverse.
inline constexpr std::array<SobolStart, 19> kSobolStarts{{
    {3, {1}},
    {7, {1, 3}},
    {11, {1, 3, 1}},
    {13, {1, 1, 1}},
    {19, {1, 1, 3, 3}},
    {25, {1, 3, 5, 13}},
    {37, {1, 1, 5, 5, 17}},
    {41, {1, 1, 5, 5, 5}},
    {47, {1, 1, 7, 11, 19}},
    {55, {1, 1, 5, 1, 1}},
    {59, {1, 1, 1, 3, 11}},
    {61, {1, 3, 5, 5, 31}},
    {67, {1, 3, 3, 9, 7, 49}},
    {91, {1, 1, 1, 15, 21, 21}},
    {97, {1, 3, 1, 13, 27, 49}},
    {103, {1, 1, 1, 15, 7, 5}},
    {109, {1, 3, 1, 15, 13, 25}},
    {115, {1, 1, 5, 5, 19, 61}},
    {131, {1, 3, 7, 11, 23, 15, 103}},
}};
inline constexpr int kSobolDimensions = 1 + int(kSobolStarts.size());

/// By bit of the index, what it flips in the number. The number's digits run from the lowest bit on: bit 0 is
/// worth 1/2, so that carries of an addition run from coarse digits to fine ones.
using SobolColumns = std::array<std::uint32_t, kSobolBits>;

constexpr SobolColumns sobol_columns(int dimension) {
  SobolColumns columns{};
  if (dimension == 0) {
    for (int i = 0; i < kSobolBits; ++i) columns[std::size_t(i)] = std::uint32_t(1) << i;
    return columns;
  }
  const SobolStart& start = kSobolStarts[std::size_t(dimension - 1)];
  int degree = 0;
  while (start.polynomial >> (degree + 1) != 0) ++degree;
  // m_i as integers below 2^(i + 1): digit j of column i is bit i - j of m_i.
  std::array<std::uint64_t, kSobolBits> m{};
  for (int i = 0; i < kSobolBits; ++i) {
    auto& value = m[std::size_t(i)];
    if (i < degree) {
      value = start.odd[std::size_t(i)];
    } else {
      const std::uint64_t oldest = m[std::size_t(i - degree)];
      value = oldest ^ (oldest << degree);
      for (int k = 1; k < degree; ++k) {
        if (start.polynomial >> (degree - k) & 1) value ^= m[std::size_t(i - k)] << k;
      }
    }
    for (int j = 0; j <= i; ++j) {
      columns[std::size_t(i)] |= std::uint32_t(value >> (i - j) & 1) << j;
    }
  }
  return columns;
}

}  // namespace spectrace
